#pragma once

#include <Eigen/Cholesky>

#include "traverse/inertial/navigation.hpp"

namespace traverse::inertial {

/// The value that chi-square of `rows` degrees of freedom exceeds with a probability of 0.1 %
/// (Abramowitz and Stegun, table 26.8).
inline double chi2_bound(int rows) {
  constexpr double kBounds[] = {0, 10.828, 13.816, 16.266, 18.467, 20.515, 22.458};
  return kBounds[rows];
}

/// The normalised innovation squared of a model (as in ModelFactor) at the predicted state:
/// r' (J P J' + R)^-1 r. Source: Bar-Shalom, Li and Kirubarajan, "Estimation with applications to
/// tracking and navigation", section 5.4.
template <typename Model>
Innovation innovation(const Model& model, const NavState& predicted, const NavState::Matrix& P,
                      const Eigen::Matrix<double, Model::kSize, Model::kSize>& R) {
  constexpr int kSize = Model::kSize;
  Jacobian<kSize> J;
  const Residual<kSize> r = model(predicted, &J);
  const Eigen::Matrix<double, kSize, kSize> S = J * P * J.transpose() + R;
  return {r.dot(S.ldlt().solve(r)), kSize, false};
}

}  // namespace traverse::inertial
