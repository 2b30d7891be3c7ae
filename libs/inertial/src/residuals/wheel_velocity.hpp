#pragma once

#include "traverse/inertial/wheel_mount.hpp"
#include "traverse/optimization/factor_kind.hpp"

#include "residuals/residual.hpp"

namespace traverse::inertial {

/// The velocity at the wheels less scale * (forward, 0, 0), in the wheels' axes as the state turns
/// them [m/s]: what they tell forward, and that they slip neither sideways nor off the ground.
struct WheelVelocityResidual {
  static constexpr int kSize = 3;
  static constexpr const char* kName = "wheel velocity";
  double forward_mps;
  WheelMount mount;
  Eigen::Vector3d angular_rate;  ///< as the IMU read it [rad/s], for the lever arm

  Residual<kSize> operator()(const NavState& x, Jacobian<kSize>* dr_dx = nullptr) const;

  static optimization::FactorKind kind();
};

}  // namespace traverse::inertial
