#include "evidence/evidence.hpp"

#include <memory>
#include <variant>

#include "traverse/geometry/so3.hpp"

namespace traverse::plausibility {

void OdometryTrack::take(double t, const geometry::Pose3& T_map_body) {
  constexpr double kGap_s = 3;  // thinned recordings have a scan a second
  const double dt = last_t_ ? t - *last_t_ : 0;
  const bool is_gap = dt > kGap_s;
  const Eigen::Vector3d step = T_map_body.translation - last_.translation;
  turn.add(t, geometry::log_so3(last_.rotation.transpose() * T_map_body.rotation), is_gap);
  way.add(t, step, is_gap);
  forward.add(t, Accumulated<1>::Vector(last_.rotation.col(0).dot(step)), is_gap);
  last_t_ = t;
  last_ = T_map_body;
}

double Evidence::seconds(geometry::Stamp stamp) {
  if (!origin_) origin_ = stamp;
  return geometry::seconds_between(*origin_, stamp);
}

void Evidence::take(const sensors::Measurement& measurement) {
  const double t = seconds(sensors::stamp_of(measurement));
  const std::string& sensor = sensors::sensor_of(measurement);
  if (const auto* imu = std::get_if<sensors::ImuSample>(&measurement)) {
    imus[sensor].take(t, *imu);
  } else if (const auto* fix = std::get_if<sensors::GnssFix>(&measurement)) {
    receivers[sensor].take(t, *fix);
  } else if (const auto* reading = std::get_if<sensors::WheelOdometry>(&measurement)) {
    const auto* mounted = recording.rig.find(sensor);
    wheels[sensor].take(t, *reading, mounted != nullptr ? mounted->encoder : std::nullopt);
  } else if (const auto* scan =
                 std::get_if<std::shared_ptr<const sensors::LidarScan>>(&measurement)) {
    lidars[sensor].take(t, **scan);
    const auto* first = recording.rig.first(sensors::SensorKind::kLidar);
    if (first != nullptr && first->label == sensor) distortion.take(*scan);
  }
}

void Evidence::take_pose(geometry::Stamp stamp, const geometry::Pose3& T_map_body) {
  odometry.take(seconds(stamp), T_map_body);
  distortion.take_pose(stamp, T_map_body, recording.rig);
}

Eigen::Matrix3d Evidence::R_body(const std::string& sensor) const {
  const auto* mounted = recording.rig.find(sensor);
  return mounted != nullptr ? mounted->T_body_sensor.rotation : Eigen::Matrix3d::Identity();
}

}  // namespace traverse::plausibility
