#pragma once

#include <string>

#include <Eigen/Core>

#include "traverse/geometry/stamp.hpp"

namespace traverse::sensors {

/// One reading of an inertial measurement unit in its own axes.
struct ImuSample {
  geometry::Stamp stamp;
  std::string sensor;
  Eigen::Vector3d angular_rate = Eigen::Vector3d::Zero();    ///< rad/s
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();  ///< m/s^2; at rest it points up, +9.81
};

}  // namespace traverse::sensors
