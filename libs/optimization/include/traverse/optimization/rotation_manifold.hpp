#pragma once

#include <Eigen/Core>
#include <ceres/manifold.h>

#include "traverse/optimization/perturbation.hpp"

namespace traverse::optimization {

/// Unit quaternions [x y z w], moved by full-angle rotation vectors d on the right or on the left:
///     Plus(q, d) = q * e(d)   or   e(d) * q,   e(d) = [sin(|d|/2) d/|d|, cos(|d|/2)],
/// so that a tangent Jacobian is one with respect to the rotation vector of R Exp(d), or Exp(d) R.
/// (Ceres' own quaternion manifolds take half the rotation vector, on the left.)
///
/// P = PlusJacobian satisfies P'P = I/4 on either side, hence MinusJacobian = 4 P'. A factor with
/// the tangent Jacobian J returns J_ambient = J 4 P', for which J_ambient P = J and which is the
/// derivative through the normalised quaternion: ceres::GradientChecker accepts it. That derivative
/// knows no side: J_right 4 P_right' = J_left 4 P_left'.
///
/// This header shows Ceres: only sources include it, no public header.
class RotationManifold final : public ceres::Manifold {
 public:
  using PlusMatrix = Eigen::Matrix<double, 4, 3, Eigen::RowMajor>;
  using MinusMatrix = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

  explicit RotationManifold(Perturbation perturbation = Perturbation::kRight)
      : perturbation_(perturbation) {}

  int AmbientSize() const override { return 4; }
  int TangentSize() const override { return 3; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;

  /// d Plus(q, d) / dd at d = 0.
  static PlusMatrix plus_jacobian(const double* q, Perturbation perturbation);

 private:
  Perturbation perturbation_;
};

}  // namespace traverse::optimization
