#include "traverse/geometry/pose3.hpp"

#include "traverse/geometry/so3.hpp"

namespace traverse::geometry {

Pose3 Pose3::from_quaternion(const Eigen::Quaterniond& q_a_b, const Eigen::Vector3d& t_a_b) {
  return {q_a_b.normalized().toRotationMatrix(), t_a_b};
}

Pose3 Pose3::from_matrix(const Eigen::Matrix4d& T_a_b) {
  return {T_a_b.topLeftCorner<3, 3>(), T_a_b.topRightCorner<3, 1>()};
}

Pose3 Pose3::inverse() const {
  return {rotation.transpose(), -(rotation.transpose() * translation)};
}

Pose3 Pose3::orthonormalised() const { return from_quaternion(quaternion(), translation); }

Eigen::Quaterniond Pose3::quaternion() const {
  Eigen::Quaterniond q(rotation);
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return q;
}

Eigen::Matrix4d Pose3::matrix() const {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = rotation;
  T.topRightCorner<3, 1>() = translation;
  return T;
}

Pose3 operator*(const Pose3& T_a_b, const Pose3& T_b_c) {
  return {T_a_b.rotation * T_b_c.rotation, T_a_b.rotation * T_b_c.translation + T_a_b.translation};
}

Pose3 exp_se3(const Twist& twist) {
  const Eigen::Vector3d phi = twist.head<3>();
  return {exp_so3(phi), left_jacobian(phi) * twist.tail<3>()};
}

Twist log_se3(const Pose3& pose) {
  Twist twist;
  twist.head<3>() = log_so3(pose.rotation);
  twist.tail<3>() = left_jacobian_inverse(twist.head<3>()) * pose.translation;
  return twist;
}

Pose3 interpolate(const Pose3& T_map_0, const Pose3& T_map_1, double s) {
  return T_map_0 * exp_se3(s * log_se3(T_map_0.inverse() * T_map_1));
}

}  // namespace traverse::geometry
