#pragma once

#include "traverse/inertial/navigation.hpp"

#include "factors/state_factor.hpp"

namespace traverse::inertial {

/// The covariance of a residual, on the stack.
using RowsCovariance = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

/// The value that chi-square of `rows` degrees of freedom exceeds with a probability of 0.1 %
/// (Abramowitz and Stegun, table 26.8).
inline double chi2_bound(int rows) {
  constexpr double kBounds[] = {0, 10.828, 13.816, 16.266, 18.467, 20.515, 22.458};
  return kBounds[rows];
}

/// The normalised innovation squared r' (J P J' + R)^-1 r of a residual `r` at the predicted state,
/// J its derivative. Source: Bar-Shalom, Li and Kirubarajan, "Estimation with applications to
/// tracking and navigation", section 5.4.
Innovation innovation(const Rows& r, const RowsJacobian& J, const NavState::Matrix& P,
                      const RowsCovariance& R);

}  // namespace traverse::inertial
