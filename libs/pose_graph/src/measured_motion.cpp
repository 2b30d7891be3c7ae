#include "measured_motion.hpp"

#include "traverse/geometry/so3.hpp"

namespace traverse::pose_graph {

using geometry::hat;
using geometry::Matrix6;

// (R Exp(e))' = Exp(-e) R' = R' Exp(-R e);  -(R Exp(e))' (p + s) = -R' p - R' s - [R' p] e.
MeasuredMotion MeasuredMotion::inverse() const {
  const Eigen::Matrix3d R_t = T_i_j.rotation.transpose();
  Matrix6 J = Matrix6::Zero();
  J.topLeftCorner<3, 3>() = -T_i_j.rotation;
  J.bottomLeftCorner<3, 3>() = -hat(R_t * T_i_j.translation);
  J.bottomRightCorner<3, 3>() = -R_t;
  return {T_i_j.inverse(), J * covariance * J.transpose()};
}

Matrix6 MeasuredMotion::twist_covariance() const {
  Matrix6 axes = Matrix6::Identity();
  axes.bottomRightCorner<3, 3>() = T_i_j.rotation.transpose();
  return axes * covariance * axes.transpose();
}

// R1 Exp(e1) R2 Exp(e2) = R1 R2 Exp(R2' e1 + e2);
// p1 + s1 + R1 Exp(e1) (p2 + s2) = p + s1 + R1 s2 - R1 [p2] e1.
MeasuredMotion operator*(const MeasuredMotion& i_j, const MeasuredMotion& j_k) {
  const Eigen::Matrix3d& R1 = i_j.T_i_j.rotation;
  Matrix6 J1 = Matrix6::Identity();
  J1.topLeftCorner<3, 3>() = j_k.T_i_j.rotation.transpose();
  J1.bottomLeftCorner<3, 3>() = -R1 * hat(j_k.T_i_j.translation);
  Matrix6 J2 = Matrix6::Identity();
  J2.bottomRightCorner<3, 3>() = R1;
  return {i_j.T_i_j * j_k.T_i_j,
          J1 * i_j.covariance * J1.transpose() + J2 * j_k.covariance * J2.transpose()};
}

}  // namespace traverse::pose_graph
