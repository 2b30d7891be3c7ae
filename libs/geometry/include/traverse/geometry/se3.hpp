#pragma once

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"

/// The calculus of rigid motions. Twists are rotation first. Source: Barfoot, "State Estimation for
/// Robotics", 2017, section 7.1.
namespace traverse::geometry {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Ad(T): T Exp(d) T^-1 = Exp(Ad(T) d).
Matrix6 adjoint(const Pose3& pose);

/// ad(xi), the derivative of Ad(Exp(xi)): ad(xi) d = [xi, d].
Matrix6 small_adjoint(const Twist& xi);

/// Jr: Exp(xi + d) ~ Exp(xi) Exp(Jr(xi) d), by its series sum of (-ad(xi))^k / (k + 1)! (eq. 7.76),
/// to rounding for rotations up to pi.
Matrix6 right_jacobian_se3(const Twist& xi);

}  // namespace traverse::geometry
