#pragma once

#include <Eigen/Core>

#include "traverse/inertial/nav_state.hpp"

/// What navigation makes small. Each residual is one pair of files: a struct of what was measured
/// with
///     kSize, kName
///     Residual<kSize> operator()(const NavState& x, Jacobian<kSize>* dr_dx = nullptr) const
/// (or of two states i and j), a pure function with its derivative in the states' tangent on
/// request, not divided by its standard deviation yet; and kind(), which shows it to the check of
/// Jacobians beside the same residual in dual numbers, written from its definition alone. It joins
/// the list of factor_kinds.cpp.
///
/// Sources: Forster et al., T-RO 2017, eqs. 45 and 67-74 (inertial); Gao Xiang, "SLAM in autonomous
/// driving", eqs. 4.38-4.48 and chapter 4's GNSS pose and encoder velocity (the book's forms).
namespace traverse::inertial {

template <int N>
using Residual = Eigen::Matrix<double, N, 1>;
template <int N>
using Jacobian = Eigen::Matrix<double, N, NavState::kTangent>;

}  // namespace traverse::inertial
