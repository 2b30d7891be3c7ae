#pragma once

#include <optional>
#include <string>
#include <vector>

#include "traverse/bags/message_value.hpp"
#include "traverse/sensors/wheel_odometry.hpp"

#include "bags/wheel_joint_statements.hpp"

namespace traverse::dataset {

/// Two joints of a vehicle that are its wheels, one a side.
struct WheelJoints {
  std::string left;
  std::string right;
};

/// Angles of wheels are counted in pulses of this many to a radian.
inline constexpr double kPulsesPerRadian = 10'000;

/// Names of the joints of a sensor_msgs/JointState.
std::vector<std::string> joints_in(const bags::MessageValue& message);

/// The joints that are stated, or else the only ones that are called a wheel and left or right; of
/// several a side those that are called rear, which do not steer. Nothing if none can be told.
std::optional<WheelJoints> wheel_joints_of(const std::vector<std::string>& names,
                                           const WheelJointStatements& stated);

/// Pulses of the angles of both wheels; without stamp and sensor.
/// \throws UnusableMessage if the message has no angle of one of them
sensors::WheelOdometry wheel_angles_of(const bags::MessageValue& message,
                                       const WheelJoints& wheels);

}  // namespace traverse::dataset
