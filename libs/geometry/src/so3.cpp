#include "traverse/geometry/so3.hpp"

#include <cmath>

namespace traverse::geometry {

namespace {

constexpr double kSeriesBelow = 1e-4;  // rad: the next term of each series is under 1e-18 there

}  // namespace

Eigen::Matrix3d hat(const Eigen::Vector3d& a) {
  Eigen::Matrix3d cross;
  cross << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return cross;
}

Eigen::Quaterniond exp_quaternion(const Eigen::Vector3d& phi) {
  const double theta = phi.norm();
  const double sinc_half =
      theta < kSeriesBelow ? 0.5 - theta * theta / 48 : std::sin(theta / 2) / theta;
  const Eigen::Vector3d v = sinc_half * phi;
  return {std::cos(theta / 2), v.x(), v.y(), v.z()};
}

Eigen::Matrix3d exp_so3(const Eigen::Vector3d& phi) {
  return exp_quaternion(phi).normalized().toRotationMatrix();
}

Eigen::Vector3d log_quaternion(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1 : 1;  // q and -q are one rotation: take the short way
  const double w = sign * q.w();
  const Eigen::Vector3d v = sign * q.vec();
  const double norm = v.norm();
  // theta / sin(theta/2); near zero theta = 2 asin(|v|) ~ 2|v|(1 + |v|^2/6) for a unit quaternion.
  const double factor = norm < kSeriesBelow ? 2 + norm * norm / 3 : 2 * std::atan2(norm, w) / norm;
  return factor * v;
}

Eigen::Vector3d log_so3(const Eigen::Matrix3d& R) {
  return log_quaternion(Eigen::Quaterniond(R).normalized());
}

double angle_of(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  return 2 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& phi) {
  const double theta = phi.norm();
  const double theta2 = theta * theta;
  const bool small = theta < kSeriesBelow;
  const double a = small ? 0.5 - theta2 / 24 : (1 - std::cos(theta)) / theta2;
  const double b = small ? 1.0 / 6 - theta2 / 120 : (theta - std::sin(theta)) / (theta2 * theta);
  const Eigen::Matrix3d W = hat(phi);
  return Eigen::Matrix3d::Identity() - a * W + b * W * W;
}

Eigen::Matrix3d right_jacobian_inverse(const Eigen::Vector3d& phi) {
  const double theta = phi.norm();
  const double theta2 = theta * theta;
  // (1 + cos) / sin is written as the cotangent of the half angle, which is finite at pi.
  const double c = theta < kSeriesBelow ? 1.0 / 12 + theta2 / 720
                                        : 1 / theta2 - 0.5 / (theta * std::tan(theta / 2));
  const Eigen::Matrix3d W = hat(phi);
  return Eigen::Matrix3d::Identity() + 0.5 * W + c * W * W;
}

Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& phi) { return right_jacobian(-phi); }

Eigen::Matrix3d left_jacobian_inverse(const Eigen::Vector3d& phi) {
  return right_jacobian_inverse(-phi);
}

}  // namespace traverse::geometry
