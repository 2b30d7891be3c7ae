#pragma once

#include "traverse/optimization/factor_kind.hpp"

#include "residuals/residual.hpp"

namespace traverse::inertial {

/// The book's encoder: v - v_measured in the map frame [m/s], v_measured turned there once with the
/// attitude that was predicted.
struct WorldVelocityResidual {
  static constexpr int kSize = 3;
  static constexpr const char* kName = "world velocity";
  Eigen::Vector3d v_map_measured;

  Residual<kSize> operator()(const NavState& x, Jacobian<kSize>* dr_dx = nullptr) const;

  static optimization::FactorKind kind();
};

}  // namespace traverse::inertial
