#pragma once

#include <string>

#include "traverse/config/binder.hpp"

namespace traverse::dataset {

/// What can be stated of a sensor_msgs/JointState whose joints are wheels.
struct WheelJointStatements {
  std::string left_joint;  ///< empty: by the joints' names
  std::string right_joint;
  double radius_m = 0;  ///< 0: not known
};
void bind(config::Binder& binder, WheelJointStatements& wheels);

}  // namespace traverse::dataset
