#pragma once

#include "traverse/optimization/factor_kind.hpp"

#include "residuals/residual.hpp"

namespace traverse::inertial {

/// x less the state `expected`, in the tangent of `expected`.
struct PriorResidual {
  static constexpr int kSize = NavState::kTangent;
  static constexpr const char* kName = "prior";
  NavState expected;

  Residual<kSize> operator()(const NavState& x, Jacobian<kSize>* dr_dx = nullptr) const;

  static optimization::FactorKind kind();
};

}  // namespace traverse::inertial
