#pragma once

#include <Eigen/Core>
#include <ceres/manifold.h>

namespace traverse::lidar {

/// Unit quaternions [x y z w] with the perturbation of all of Traverse: right, full angle,
///     Plus(q, delta) = q * [sin(|delta|/2) delta/|delta|, cos(|delta|/2)],
/// so that a tangent Jacobian is one with respect to the rotation vector of R Exp(delta). (Ceres'
/// own quaternion manifolds take half the rotation vector, on the left.)
///
/// P = PlusJacobian satisfies P'P = I/4, hence MinusJacobian = 4 P'. A factor with the tangent
/// Jacobian J returns J_ambient = J 4 P', for which J_ambient P = J and which is the derivative
/// through the normalised quaternion: ceres::GradientChecker accepts it.
class RotationManifold final : public ceres::Manifold {
 public:
  using PlusMatrix = Eigen::Matrix<double, 4, 3, Eigen::RowMajor>;
  using MinusMatrix = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

  int AmbientSize() const override { return 4; }
  int TangentSize() const override { return 3; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;

  /// d Plus(q, delta) / d delta at delta = 0.
  static PlusMatrix plus_jacobian(const double* q);
};

}  // namespace traverse::lidar
