#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

/// The calculus of rotations. Source: Forster et al., "On-manifold preintegration for real-time
/// visual-inertial odometry", T-RO 2017, eqs. 3-9. Rotation vectors phi are in radians, [3]. Below
/// |phi| = 1e-4 the coefficients are Taylor series, so that nothing cancels.
namespace traverse::geometry {

/// Cross matrix: hat(a) * b = a x b.
Eigen::Matrix3d hat(const Eigen::Vector3d& a);

/// Rotation by the angle |phi| about the axis phi/|phi| (eq. 3).
Eigen::Matrix3d exp_so3(const Eigen::Vector3d& phi);
/// The same as a unit quaternion.
Eigen::Quaterniond exp_quaternion(const Eigen::Vector3d& phi);

/// The rotation vector of R, |phi| in [0, pi] (eq. 5). Goes through the quaternion and atan2, so it
/// is exact near 0 and near pi.
Eigen::Vector3d log_so3(const Eigen::Matrix3d& R);
Eigen::Vector3d log_quaternion(const Eigen::Quaterniond& q);

/// The angle of R in [0, pi], radians.
double angle_of(const Eigen::Matrix3d& R);

/// Jr: Exp(phi + d) ~ Exp(phi) Exp(Jr(phi) d) (eq. 8).
Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& phi);
/// Jr^-1: Log(Exp(phi) Exp(d)) ~ phi + Jr^-1(phi) d (eq. 9). Singular at |phi| = 2 pi.
Eigen::Matrix3d right_jacobian_inverse(const Eigen::Vector3d& phi);
/// Jl(phi) = Jr(-phi): Exp(phi + d) ~ Exp(Jl(phi) d) Exp(phi).
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& phi);
Eigen::Matrix3d left_jacobian_inverse(const Eigen::Vector3d& phi);

}  // namespace traverse::geometry
