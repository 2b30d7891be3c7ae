#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace traverse::geometry {

/// A rigid transform T_a_b: takes point coordinates from frame b to frame a, p_a = R p_b + t.
///
/// The rotation is kept as the matrix it was given: evaluation must use the twelve numbers of a
/// KITTI file as they stand (METRICS: "used as is"), and a matrix from a unit quaternion is
/// orthonormal to rounding. Estimators that chain many poses call orthonormalised().
struct Pose3 {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< R_a_b
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();   ///< origin of b in a, metres

  static Pose3 identity() { return {}; }
  static Pose3 from_quaternion(const Eigen::Quaterniond& q_a_b, const Eigen::Vector3d& t_a_b);
  static Pose3 from_matrix(const Eigen::Matrix4d& T_a_b);

  Pose3 inverse() const;          ///< T_b_a, by the transpose
  Pose3 orthonormalised() const;  ///< rotation replaced by the nearest through its quaternion
  Eigen::Quaterniond quaternion() const;  ///< unit, w >= 0
  Eigen::Matrix4d matrix() const;

  Eigen::Vector3d operator*(const Eigen::Vector3d& p_b) const {
    return rotation * p_b + translation;
  }
};

/// T_a_c = T_a_b T_b_c.
Pose3 operator*(const Pose3& T_a_b, const Pose3& T_b_c);

/// Six numbers of a motion: rotation vector [rad] first, then translation part [m].
using Twist = Eigen::Matrix<double, 6, 1>;

/// Exp of SE(3): R = Exp(phi), t = Jl(phi) rho for the twist (phi, rho).
Pose3 exp_se3(const Twist& twist);
/// Log of SE(3), the inverse of exp_se3 for rotations below pi.
Twist log_se3(const Pose3& pose);

/// The pose a fraction s of the way from T_map_0 to T_map_1 at constant body twist:
/// T_map_0 Exp(s Log(T_map_0^-1 T_map_1)). s outside [0, 1] extrapolates.
Pose3 interpolate(const Pose3& T_map_0, const Pose3& T_map_1, double s);

}  // namespace traverse::geometry
