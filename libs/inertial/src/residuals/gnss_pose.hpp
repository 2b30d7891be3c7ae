#pragma once

#include "traverse/geometry/pose3.hpp"
#include "traverse/optimization/factor_kind.hpp"

#include "residuals/residual.hpp"

namespace traverse::inertial {

/// The book's GNSS pose: (Log(R_measured' R), p - p_measured) [rad, m]. It levels a vehicle that
/// stands on a slope, because a heading is given as a whole rotation.
struct GnssPoseResidual {
  static constexpr int kSize = 6;
  static constexpr const char* kName = "GNSS pose";
  geometry::Pose3 T_map_body_measured;

  Residual<kSize> operator()(const NavState& x, Jacobian<kSize>* dr_dx = nullptr) const;

  static optimization::FactorKind kind();
};

}  // namespace traverse::inertial
