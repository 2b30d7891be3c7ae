#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "evidence/evidence.hpp"

namespace traverse::plausibility {

/// A stream that tells how much there was of something between two moments.
struct MotionSource {
  std::string name;  ///< for people: "the lidar", "the wheels"
  std::function<std::optional<double>(double t0, double t1)> between;
};

/// The turn of the body about its z axis [rad, counterclockwise] as a gyro says.
MotionSource gyro_turn(const Evidence& evidence, const std::string& imu);

/// Streams that tell the turn and are no gyro, the best first: lidar odometry, wheels.
std::vector<MotionSource> other_turns(const Evidence& evidence);

/// Streams that tell the distance ahead [m] and are no wheels, the best first: lidar odometry.
std::optional<MotionSource> odometry_distance(const Evidence& evidence);
MotionSource wheel_distance(const Evidence& evidence, const std::string& wheels);

}  // namespace traverse::plausibility
