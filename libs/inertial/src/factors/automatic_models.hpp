#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <ceres/jet.h>

#include "traverse/inertial/residuals.hpp"

/// The residuals once more, written for any number type from their definitions alone, so that
/// Ceres' dual numbers can derive what residuals.cpp derives by hand.
namespace traverse::inertial::automatic {

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <typename T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;
template <typename T>
using Quaternion = Eigen::Quaternion<T>;

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

template <typename T>
void inertial(const Preintegration& imu, const Eigen::Vector3d& gravity, const State<T>& i,
              const State<T>& j, T* residual) {
  const auto& d = imu.bias_jacobians();
  const T seconds(imu.seconds());
  const Vector3<T> d_gyro = i.gyro_bias - imu.gyro_bias().cast<T>();
  const Vector3<T> d_accelerometer = i.accelerometer_bias - imu.accelerometer_bias().cast<T>();
  const Quaternion<T> q_measured =
      Eigen::Quaterniond(imu.increments().rotation).cast<T>() *
      exp_quaternion<T>(Vector3<T>(d.rotation_gyro.cast<T>() * d_gyro));
  const Vector3<T> v_measured = imu.increments().velocity.cast<T>() +
                                d.velocity_gyro.cast<T>() * d_gyro +
                                d.velocity_accelerometer.cast<T>() * d_accelerometer;
  const Vector3<T> p_measured = imu.increments().position.cast<T>() +
                                d.position_gyro.cast<T>() * d_gyro +
                                d.position_accelerometer.cast<T>() * d_accelerometer;
  const Vector3<T> g = gravity.cast<T>();
  Eigen::Map<Eigen::Matrix<T, 9, 1>> r(residual);
  r.template segment<3>(0) = log_quaternion<T>(q_measured.conjugate() * i.q.conjugate() * j.q);
  r.template segment<3>(3) = i.q.conjugate() * Vector3<T>(j.v - i.v - g * seconds) - v_measured;
  r.template segment<3>(6) =
      i.q.conjugate() * Vector3<T>(j.p - i.p - i.v * seconds - g * (seconds * seconds / T(2))) -
      p_measured;
}

template <typename T>
void prior(const NavState& expected, const State<T>& x, T* residual) {
  Eigen::Map<Eigen::Matrix<T, NavState::kTangent, 1>> r(residual);
  r.template segment<3>(0) = log_quaternion<T>(expected.q_map_body.cast<T>().conjugate() * x.q);
  r.template segment<3>(3) = x.p - expected.p_map.cast<T>();
  r.template segment<3>(6) = x.v - expected.v_map.cast<T>();
  r.template segment<3>(9) = x.gyro_bias - expected.gyro_bias.cast<T>();
  r.template segment<3>(12) = x.accelerometer_bias - expected.accelerometer_bias.cast<T>();
  r[15] = x.wheel_scale - T(expected.wheel_scale);
  r.template segment<2>(16) = x.wheel_turn - expected.wheel_turn.cast<T>();
  r[18] = x.gnss_latency - T(expected.gnss_latency);
  r.template segment<3>(19) = x.gnss_bias - expected.gnss_bias.cast<T>();
}

template <typename T>
void gnss_position(const AntennaFix& fix, const State<T>& x, T* residual) {
  const Vector3<T> lever = fix.lever_body.cast<T>();
  const Vector3<T> turning = fix.angular_rate.cast<T>() - x.gyro_bias;
  const Vector3<T> v = x.v + x.q * Vector3<T>(turning.cross(lever));
  const Vector3<T> a = fix.acceleration_map.cast<T>();
  const T t = x.gnss_latency;
  Eigen::Map<Vector3<T>> r(residual);
  r = x.q * lever + x.p - v * t + a * (t * t / T(2)) + x.gnss_bias - fix.p_map.cast<T>();
}

template <typename T>
void heading(double measured, const State<T>& x, T* residual) {
  using std::atan2;
  using std::cos;
  using std::sin;
  const T yaw = atan2(x.R(1, 0), x.R(0, 0));
  residual[0] = atan2(sin(yaw - T(measured)), cos(yaw - T(measured)));
}

template <typename T>
void wheel_velocity(double forward, const WheelMount& mount, const Eigen::Vector3d& rate,
                    const State<T>& x, T* residual) {
  const Vector3<T> turning = rate.cast<T>() - x.gyro_bias;
  const Vector3<T> lever = mount.p_body.cast<T>();
  const Vector3<T> at_wheels = x.q.conjugate() * x.v + turning.cross(lever);
  Eigen::Map<Vector3<T>> r(residual);
  const Vector3<T> turn(T(0), x.wheel_turn[0], x.wheel_turn[1]);
  r = exp_quaternion<T>(turn) * Vector3<T>(mount.R_wheels_body.cast<T>() * at_wheels);
  r[0] -= x.wheel_scale * T(forward);
}

template <typename T>
void zero_velocity(const Eigen::Vector3d& rate, const State<T>& x, T* residual) {
  Eigen::Map<Eigen::Matrix<T, 6, 1>> r(residual);
  r << x.v, rate.cast<T>() - x.gyro_bias;
}

template <typename T>
void gnss_pose(const geometry::Pose3& measured, const State<T>& x, T* residual) {
  Eigen::Map<Eigen::Matrix<T, 6, 1>> r(residual);
  r << log_quaternion<T>(measured.quaternion().cast<T>().conjugate() * x.q),
      x.p - measured.translation.cast<T>();
}

template <typename T>
void world_velocity(const Eigen::Vector3d& measured, const State<T>& x, T* residual) {
  Eigen::Map<Vector3<T>> r(residual);
  r = x.v - measured.cast<T>();
}

}  // namespace traverse::inertial::automatic
