#include "navigation/map_fix.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "traverse/geometry/angle.hpp"

namespace traverse::inertial {

namespace {

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
  if (std::isnan(fix.altitude_m)) {
    ++events["fix without altitude"];
    return false;
  }
  return true;
}

MapFix in_map(const sensors::GnssFix& fix, const geodesy::LocalTangentPlane& plane,
              const GnssOptions& options, double baseline_angle, Events& events) {
  MapFix result;
  result.stamp = fix.stamp;
  result.p_antenna_map = plane.to_enu({fix.latitude_deg, fix.longitude_deg, fix.altitude_m});
  const double h = options.horizontal_m * options.horizontal_m;
  result.covariance = Eigen::Vector3d(h, h, options.vertical_m * options.vertical_m).asDiagonal();
  if (options.use_covariance && fix.covariance_enu) {
    if (is_positive_definite(*fix.covariance_enu)) {
      result.covariance = *fix.covariance_enu;
    } else {
      ++events["fix whose covariance is not positive definite"];
    }
  }
  if (options.use_heading && fix.heading_deg && std::isfinite(*fix.heading_deg)) {
    result.heading = std::remainder((90 - *fix.heading_deg) * geometry::kDegree - baseline_angle,
                                    2 * std::numbers::pi);
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
