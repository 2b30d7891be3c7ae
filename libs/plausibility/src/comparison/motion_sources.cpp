#include "comparison/motion_sources.hpp"

namespace traverse::plausibility {

MotionSource gyro_turn(const Evidence& evidence, const std::string& imu) {
  const Accumulated<3>& turn = evidence.imus.at(imu).turn();
  const Eigen::Vector3d z_imu = evidence.R_body(imu).row(2);
  return {imu, [&turn, z_imu](double t0, double t1) -> std::optional<double> {
            const auto angle = turn.between(t0, t1);
            return angle ? std::optional(z_imu.dot(*angle)) : std::nullopt;
          }};
}

std::vector<MotionSource> other_turns(const Evidence& evidence) {
  std::vector<MotionSource> sources;
  if (!evidence.odometry.turn.empty()) {
    sources.push_back({"the lidar's odometry", [&](double t0, double t1) -> std::optional<double> {
                         const auto angle = evidence.odometry.turn.between(t0, t1);
                         return angle ? std::optional(angle->z()) : std::nullopt;
                       }});
  }
  for (const auto& [label, track] : evidence.wheels) {
    if (track.turn().empty()) continue;
    sources.push_back(
        {label, [&turn = track.turn()](double t0, double t1) -> std::optional<double> {
           const auto angle = turn.between(t0, t1);
           return angle ? std::optional((*angle)[0]) : std::nullopt;
         }});
  }
  return sources;
}

std::optional<MotionSource> odometry_distance(const Evidence& evidence) {
  if (evidence.odometry.forward.empty()) return std::nullopt;
  return MotionSource{"the lidar's odometry", [&](double t0, double t1) -> std::optional<double> {
                        const auto way = evidence.odometry.forward.between(t0, t1);
                        return way ? std::optional((*way)[0]) : std::nullopt;
                      }};
}

MotionSource wheel_distance(const Evidence& evidence, const std::string& wheels) {
  const Accumulated<3>& distance = evidence.wheels.at(wheels).distance();
  return {wheels, [&distance](double t0, double t1) -> std::optional<double> {
            const auto way = distance.between(t0, t1);
            return way ? std::optional((*way)[WheelTrack::kAsRead]) : std::nullopt;
          }};
}

}  // namespace traverse::plausibility
