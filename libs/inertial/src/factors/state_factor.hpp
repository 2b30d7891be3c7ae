#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "residuals/residual.hpp"

namespace traverse::inertial {

/// A residual's rows and their derivatives, on the stack.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
using RowsJacobian =
    Eigen::Matrix<double, Eigen::Dynamic, NavState::kTangent, 0, 6, NavState::kTangent>;

/// The W for which |W r|^2 = r' covariance^-1 r.
template <int N>
Eigen::Matrix<double, N, N> square_root_information(const Eigen::Matrix<double, N, N>& covariance) {
  using Matrix = Eigen::Matrix<double, N, N>;
  const Eigen::LLT<Matrix> llt(covariance);
  Matrix W = Matrix::Identity();
  llt.matrixL().solveInPlace(W);
  return W;
}

/// A constraint on one state, in units of its standard deviation.
class StateFactor {
 public:
  virtual ~StateFactor() = default;

  virtual void evaluate(const NavState& x, Rows& r, RowsJacobian* dr_dx) const = 0;

  /// Where Huber's loss goes over from a square to a line, in standard deviations; 0 for never.
  double huber = 0;
};

/// A StateFactor from a residual as residual.hpp says.
template <typename Model>
class ModelFactor final : public StateFactor {
 public:
  static constexpr int kSize = Model::kSize;
  using Weight = Eigen::Matrix<double, kSize, kSize>;

  ModelFactor(const Model& model, const Weight& square_root_information)
      : model_(model), weight_(square_root_information) {}

  void evaluate(const NavState& x, Rows& r, RowsJacobian* dr_dx) const override {
    if (dr_dx == nullptr) {
      r = weight_ * model_(x, nullptr);
      return;
    }
    Jacobian<kSize> J;
    r = weight_ * model_(x, &J);
    *dr_dx = weight_ * J;
  }

 private:
  Model model_;
  Weight weight_;
};

}  // namespace traverse::inertial
