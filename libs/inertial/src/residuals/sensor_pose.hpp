#pragma once

#include "traverse/geometry/pose3.hpp"
#include "traverse/optimization/factor_kind.hpp"

#include "residuals/residual.hpp"

namespace traverse::inertial {

/// The pose of a sensor that shares the body's axes less where something else than the IMU found
/// it: rotation [rad] on the right, then position [m], map frame. A lidar's condensed matches are
/// this, weighted by the square root of their information.
struct SensorPoseResidual {
  static constexpr int kSize = 6;
  static constexpr const char* kName = "sensor pose";
  geometry::Pose3 T_map_sensor;  ///< as it was found
  Eigen::Vector3d p_body;        ///< of the sensor [m]

  Residual<kSize> operator()(const NavState& x, Jacobian<kSize>* dr_dx = nullptr) const;

  static optimization::FactorKind kind();
};

}  // namespace traverse::inertial
