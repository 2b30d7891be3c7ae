#include "navigation/map_fix.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "traverse/geometry/angle.hpp"

namespace traverse::inertial {

namespace {

constexpr double kWavelength = 0.19;  // m, of L1
constexpr double kAutonomous = 1;     // m, of a fix by one receiver's code alone, horizontally

bool is_positive_definite(const Eigen::Matrix3d& P) {
  if (!P.allFinite() || (P - P.transpose()).norm() > 1e-6 * P.norm()) return false;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(P, Eigen::EigenvaluesOnly)
             .eigenvalues()
             .minCoeff() > 1e-12;
}

}  // namespace

bool is_place(const sensors::GnssFix& fix, Events& events) {
  if (!std::isfinite(fix.latitude_deg) || !std::isfinite(fix.longitude_deg) ||
      std::abs(fix.latitude_deg) > 90) {
    ++events["fix that is no place"];
    return false;
  }
  if (fix.latitude_deg == 0 && fix.longitude_deg == 0) {
    ++events["fix at latitude 0, longitude 0: the receiver had none"];
    return false;
  }
  if (std::isinf(fix.altitude_m)) {
    ++events["fix that is no place"];
    return false;
  }
  if (std::isnan(fix.altitude_m)) {
    ++events["fix without altitude"];
    return false;
  }
  return true;
}

MapFix in_map(const sensors::GnssFix& fix, const geodesy::LocalTangentPlane& plane,
              const GnssOptions& options, double baseline_angle, const FixScatter& scatter,
              Events& events) {
  MapFix result;
  result.stamp = fix.stamp;
  result.p_antenna_map = plane.to_enu({fix.latitude_deg, fix.longitude_deg, fix.altitude_m});
  const bool is_stated = options.horizontal_m > 0 && options.vertical_m > 0;
  const auto scattered = scatter.sigma();
  const FixScatter::Sigma found =
      scattered.value_or(FixScatter::Sigma{kAutonomous, 2 * kAutonomous});
  const double horizontal = options.horizontal_m > 0 ? options.horizontal_m : found.horizontal_m;
  const double vertical = options.vertical_m > 0 ? options.vertical_m : found.vertical_m;
  result.is_sigma_known = is_stated || scattered;
  result.step_m = is_stated ? 0 : kWavelength;
  result.covariance = Eigen::Vector3d(horizontal, horizontal, vertical).cwiseAbs2().asDiagonal();
  if (options.use_covariance && fix.covariance_enu) {
    if (is_positive_definite(*fix.covariance_enu)) {
      result.covariance = *fix.covariance_enu;
      result.is_sigma_known = true;
      result.step_m = 0;
    } else {
      ++events["fix whose covariance is not positive definite"];
    }
  }
  if (options.use_heading && fix.heading_deg && std::isfinite(*fix.heading_deg)) {
    result.heading = std::remainder((90 - *fix.heading_deg) * geometry::kDegree - baseline_angle,
                                    2 * std::numbers::pi);
    result.heading_sigma = options.heading_deg * geometry::kDegree;
  }
  return result;
}

MapFix interpolated(const MapFix& before, const MapFix& after, geometry::Stamp stamp) {
  const double span = geometry::seconds_between(before.stamp, after.stamp);
  const double share = span > 0 ? geometry::seconds_between(before.stamp, stamp) / span : 1;
  MapFix fix = after;
  fix.stamp = stamp;
  fix.p_antenna_map = (1 - share) * before.p_antenna_map + share * after.p_antenna_map;
  fix.heading.reset();
  return fix;
}

}  // namespace traverse::inertial
