#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "traverse/geometry/so3.hpp"
#include "traverse/lidar/odometry.hpp"

#include "lidar/simulated_drive.hpp"

namespace traverse::testing {

/// The frames of a whole drive; each inertial sample is given before the scan that follows it.
inline std::vector<lidar::Frame> frames_of(lidar::Odometry& odometry, const SimulatedDrive& drive,
                                           const std::vector<sensors::ImuSample>& imu = {}) {
  std::vector<lidar::Frame> frames;
  auto sample = imu.begin();
  for (const auto& scan : drive.scans) {
    for (; sample != imu.end() && sample->stamp <= scan.stamp; ++sample) odometry.observe(*sample);
    for (const lidar::Frame& frame : odometry.process(scan)) frames.push_back(frame);
  }
  for (const lidar::Frame& frame : odometry.finish()) frames.push_back(frame);
  return frames;
}

/// Metres from the truth; the map frame is that of the first scan.
inline double position_error(const lidar::Frame& frame, const SimulatedDrive& drive) {
  return (frame.T_map_lidar.translation - drive.truth[frame.index].translation).norm();
}

/// Radians from the truth.
inline double rotation_error(const lidar::Frame& frame, const SimulatedDrive& drive) {
  return geometry::angle_of(drive.truth[frame.index].rotation.transpose() *
                            frame.T_map_lidar.rotation);
}

/// The largest position_error; not finite if one is not.
inline double worst_position_error(const std::vector<lidar::Frame>& frames,
                                   const SimulatedDrive& drive) {
  double worst = 0;
  for (const lidar::Frame& frame : frames) {
    const double error = position_error(frame, drive);
    if (!std::isfinite(error)) return error;  // std::max would pass over it
    worst = std::max(worst, error);
  }
  return worst;
}

}  // namespace traverse::testing
