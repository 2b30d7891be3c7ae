#pragma once

#include <Eigen/Core>

namespace traverse::inertial {

/// Where the wheels' velocity is measured and in which axes.
struct WheelMount {
  Eigen::Matrix3d R_wheels_body = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();  ///< middle of the rear axle, in the body [m]
};

}  // namespace traverse::inertial
