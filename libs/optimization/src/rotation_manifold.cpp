#include "traverse/optimization/rotation_manifold.hpp"

#include <cmath>

#include "traverse/geometry/so3.hpp"

namespace traverse::optimization {

using ConstQuaternion = Eigen::Map<const Eigen::Quaterniond>;

RotationManifold::PlusMatrix RotationManifold::plus_jacobian(const double* q,
                                                             Perturbation perturbation) {
  // The vector part of q * e(d) moves by (w d + v x d) / 2, that of e(d) * q by (w d - v x d) / 2.
  const double side = perturbation == Perturbation::kRight ? 1 : -1;
  const double x = side * q[0];
  const double y = side * q[1];
  const double z = side * q[2];
  const double w = q[3];
  PlusMatrix P;
  P << w, -z, y,  //
      z, w, -x,   //
      -y, x, w,   //
      -q[0], -q[1], -q[2];
  return 0.5 * P;
}

bool RotationManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  const Eigen::Quaterniond step =
      geometry::exp_quaternion(Eigen::Map<const Eigen::Vector3d>(delta));
  const ConstQuaternion q(x);
  Eigen::Map<Eigen::Quaterniond> result(x_plus_delta);
  result = (perturbation_ == Perturbation::kRight ? q * step : step * q).normalized();
  return true;
}

bool RotationManifold::PlusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<PlusMatrix> P(jacobian);
  P = plus_jacobian(x, perturbation_);
  return true;
}

bool RotationManifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  // Up to a full turn, without going over to -q: Plus must give y back, not -y.
  const Eigen::Quaterniond x_inverse = ConstQuaternion(x).conjugate();
  const Eigen::Quaterniond step = perturbation_ == Perturbation::kRight
                                      ? x_inverse * ConstQuaternion(y)
                                      : ConstQuaternion(y) * x_inverse;
  const double half_angle = std::atan2(step.vec().norm(), step.w());
  const double sine = step.vec().norm();
  Eigen::Map<Eigen::Vector3d> difference(y_minus_x);
  difference = (sine < 1e-12 ? 2 : 2 * half_angle / sine) * step.vec();
  return true;
}

bool RotationManifold::MinusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<MinusMatrix> M(jacobian);
  M = 4 * plus_jacobian(x, perturbation_).transpose();
  return true;
}

}  // namespace traverse::optimization
