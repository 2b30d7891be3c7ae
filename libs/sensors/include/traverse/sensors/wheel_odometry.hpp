#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/stamp.hpp"

namespace traverse::sensors {

/// One reading of a vehicle's wheel odometry; recordings hold one or several of its three forms.
struct WheelOdometry {
  struct Ticks {
    std::int64_t left = 0;  ///< encoder pulses since the recording's start
    std::int64_t right = 0;
  };
  struct Velocity {
    double forward_mps = 0;
    double left_mps = 0;
    double yaw_rate = 0;  ///< rad/s, counterclockwise
  };

  geometry::Stamp stamp;
  std::string sensor;
  std::optional<geometry::Pose3> T_odom_body;  ///< dead-reckoned by the vehicle
  std::optional<Ticks> ticks;
  std::optional<Velocity> velocity;
};

}  // namespace traverse::sensors
