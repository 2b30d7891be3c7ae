#pragma once

#include "traverse/optimization/factor_kind.hpp"

#include "residuals/residual.hpp"

namespace traverse::inertial {

/// The heading of the body's x axis less the one measured, wrapped to (-pi, pi] [rad], from the
/// map's x axis counterclockwise. Undefined when the x axis is vertical: derivative and value are
/// then zero.
struct HeadingResidual {
  static constexpr int kSize = 1;
  static constexpr const char* kName = "heading";
  double heading;

  Residual<kSize> operator()(const NavState& x, Jacobian<kSize>* dr_dx = nullptr) const;

  static optimization::FactorKind kind();
};

}  // namespace traverse::inertial
