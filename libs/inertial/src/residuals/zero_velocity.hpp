#pragma once

#include "traverse/optimization/factor_kind.hpp"

#include "residuals/residual.hpp"

namespace traverse::inertial {

/// Standing still: velocity [m/s], then angular rate less bias [rad/s].
struct ZeroVelocityResidual {
  static constexpr int kSize = 6;
  static constexpr const char* kName = "zero velocity";
  Eigen::Vector3d angular_rate;  ///< as the IMU read it [rad/s]

  Residual<kSize> operator()(const NavState& x, Jacobian<kSize>* dr_dx = nullptr) const;

  static optimization::FactorKind kind();
};

}  // namespace traverse::inertial
