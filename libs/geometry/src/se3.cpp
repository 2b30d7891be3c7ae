#include "traverse/geometry/se3.hpp"

#include "traverse/geometry/so3.hpp"

namespace traverse::geometry {

Matrix6 adjoint(const Pose3& pose) {
  Matrix6 Ad = Matrix6::Zero();
  Ad.topLeftCorner<3, 3>() = pose.rotation;
  Ad.bottomRightCorner<3, 3>() = pose.rotation;
  Ad.bottomLeftCorner<3, 3>() = hat(pose.translation) * pose.rotation;
  return Ad;
}

Matrix6 small_adjoint(const Twist& xi) {
  Matrix6 ad = Matrix6::Zero();
  ad.topLeftCorner<3, 3>() = hat(xi.head<3>());
  ad.bottomRightCorner<3, 3>() = hat(xi.head<3>());
  ad.bottomLeftCorner<3, 3>() = hat(xi.tail<3>());
  return ad;
}

Matrix6 right_jacobian_se3(const Twist& xi) {
  constexpr int kTerms = 30;  // pi^30 / 31! < 1e-18
  const Matrix6 ad = small_adjoint(xi);
  Matrix6 term = Matrix6::Identity();
  Matrix6 sum = term;
  for (int k = 1; k <= kTerms; ++k) {
    term = (term * ad / -(k + 1)).eval();
    sum += term;
  }
  return sum;
}

}  // namespace traverse::geometry
