#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <ceres/jet.h>

/// A state in any number type, for residuals that Ceres' dual numbers derive.
namespace traverse::inertial::automatic {

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <typename T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;
template <typename T>
using Quaternion = Eigen::Quaternion<T>;

/// From the blocks of state_blocks.hpp.
template <typename T>
struct State {
  explicit State(T const* const* blocks)
      : q(Eigen::Map<const Quaternion<T>>(blocks[0]).normalized()),
        R(q.toRotationMatrix()),
        p(blocks[1]),
        v(blocks[2]),
        gyro_bias(blocks[3]),
        accelerometer_bias(blocks[4]),
        wheel_scale(*blocks[5]),
        wheel_turn(blocks[6]),
        gnss_latency(*blocks[7]),
        gnss_bias(blocks[8]) {}

  Quaternion<T> q;
  Matrix3<T> R;
  Vector3<T> p, v, gyro_bias, accelerometer_bias;
  T wheel_scale;
  Eigen::Matrix<T, 2, 1> wheel_turn;
  T gnss_latency;
  Vector3<T> gnss_bias;
};

/// Away from the identity, where checks are made.
template <typename T>
Vector3<T> log_quaternion(Quaternion<T> q) {
  using std::atan2;
  if (q.w() < T(0)) q.coeffs() = -q.coeffs();
  const T sine = q.vec().norm();
  return Vector3<T>(q.vec() * (T(2) * atan2(sine, q.w()) / sine));
}

template <typename T>
Quaternion<T> exp_quaternion(const Vector3<T>& phi) {
  using std::cos;
  using std::sin;
  const T angle = phi.norm();
  Quaternion<T> q;
  q.w() = cos(angle / T(2));
  q.vec() = phi * (sin(angle / T(2)) / angle);
  return q;
}

}  // namespace traverse::inertial::automatic
