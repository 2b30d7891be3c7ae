#include "path_estimator.hpp"

#include <cmath>
#include <numbers>
#include <variant>

namespace traverse::replay {

using geometry::Pose3;

namespace {

constexpr double kSemiMajor = 6378137.0;  // WGS84
constexpr double kFlattening = 1 / 298.257223563;

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// Earth-centred coordinates, and the axes east, north and up there.
/// Source: NIMA TR8350.2, "World Geodetic System 1984", section 4.
Pose3 ecef_of(const sensors::GnssFix& fix) {
  const double lat = radians(fix.latitude_deg);
  const double lon = radians(fix.longitude_deg);
  const double height = std::isfinite(fix.altitude_m) ? fix.altitude_m : 0;
  const double e2 = kFlattening * (2 - kFlattening);
  const double n = kSemiMajor / std::sqrt(1 - e2 * std::sin(lat) * std::sin(lat));
  Pose3 T_ecef_local;
  T_ecef_local.translation = {(n + height) * std::cos(lat) * std::cos(lon),
                              (n + height) * std::cos(lat) * std::sin(lon),
                              (n * (1 - e2) + height) * std::sin(lat)};
  T_ecef_local.rotation.col(0) = Eigen::Vector3d(-std::sin(lon), std::cos(lon), 0);
  T_ecef_local.rotation.col(1) = Eigen::Vector3d(-std::sin(lat) * std::cos(lon),
                                                 -std::sin(lat) * std::sin(lon), std::cos(lat));
  T_ecef_local.rotation.col(2) =
      Eigen::Vector3d(std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat));
  return T_ecef_local;
}

}  // namespace

const std::vector<std::string>& PathEstimator::columns() const {
  static const std::vector<std::string> kColumns{"has_odometry", "has_gnss"};
  return kColumns;
}

std::vector<pipeline::PoseFrame> PathEstimator::process(const sensors::Measurement& measurement) {
  if (const auto* odometry = std::get_if<sensors::WheelOdometry>(&measurement)) observe(*odometry);
  if (const auto* fix = std::get_if<sensors::GnssFix>(&measurement)) observe(*fix);
  if (sensors::sensor_of(measurement) != frame_sensor_) return {};
  pipeline::PoseFrame frame;
  frame.stamp = sensors::stamp_of(measurement);
  frame.T_map_body = present().value_or(Pose3::identity());
  frame.record = {T_odom_body_ ? 1.0 : 0.0, p_local_ ? 1.0 : 0.0};
  return {frame};
}

void PathEstimator::observe(const sensors::WheelOdometry& odometry) {
  if (!odometry.T_odom_body) return;
  if (!T_odom_first_) T_odom_first_ = odometry.T_odom_body;
  T_odom_body_ = odometry.T_odom_body;
}

void PathEstimator::observe(const sensors::GnssFix& fix) {
  const Pose3 T_ecef_here = ecef_of(fix);
  if (!T_ecef_local_) T_ecef_local_ = T_ecef_here;
  p_local_ = T_ecef_local_->inverse() * T_ecef_here.translation;
}

std::optional<Pose3> PathEstimator::present() const {
  if (T_odom_body_) return T_odom_first_->inverse() * *T_odom_body_;
  if (!p_local_) return std::nullopt;
  Pose3 pose;
  pose.translation = *p_local_;
  return pose;
}

pipeline::UsedScan PathEstimator::used_scan(const sensors::LidarScan& scan,
                                            const pipeline::PoseFrame&, bool) const {
  return {scan.x, scan.y, scan.z, {}, {}};
}

std::vector<pipeline::Decision> PathEstimator::decisions() const {
  return {{"path", "the recording's own odometry or satellite fixes; nothing is estimated"}};
}

}  // namespace traverse::replay
