#include "factors/preintegration.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "traverse/geometry/so3.hpp"

namespace traverse::inertial {

using geometry::exp_so3;
using geometry::hat;
using geometry::right_jacobian;

Preintegration::Preintegration(const ImuNoise& noise, const Eigen::Vector3d& gyro_bias,
                               const Eigen::Vector3d& accelerometer_bias)
    : noise_(noise), gyro_bias_(gyro_bias), accelerometer_bias_(accelerometer_bias) {}

void Preintegration::add(const Eigen::Vector3d& angular_rate, const Eigen::Vector3d& specific_force,
                         double seconds, const NoiseScale& noise_scale) {
  if (!(seconds > 0) || !std::isfinite(seconds)) {
    throw std::invalid_argument(fmt::format(
        "an IMU sample must last more than 0 s to be integrated, this lasts {}", seconds));
  }
  if (!angular_rate.allFinite() || !specific_force.allFinite()) {
    throw std::invalid_argument("an IMU sample with a number that is not finite");
  }
  samples_.push_back({angular_rate, specific_force, seconds, noise_scale});
  integrate(samples_.back());
}

void Preintegration::split_single_sample() {
  if (samples_.size() != 1) return;
  samples_.front().seconds /= 2;
  samples_.push_back(samples_.front());
  reintegrate(Eigen::Vector3d(gyro_bias_), Eigen::Vector3d(accelerometer_bias_));
}

void Preintegration::integrate(const Sample& sample) {
  const double dt = sample.seconds;
  const Eigen::Vector3d phi = (sample.angular_rate - gyro_bias_) * dt;
  const Eigen::Vector3d a = sample.specific_force - accelerometer_bias_;
  const Eigen::Matrix3d E = exp_so3(phi);
  const Eigen::Matrix3d J = right_jacobian(phi);
  const Eigen::Matrix3d R = increments_.rotation;  // old: everything below stands before the step
  const Eigen::Matrix3d R_a = R * hat(a);

  // Covariance, Forster et al. eqs. 62-63: A carries the errors so far, B brings in the sample's,
  // whose variance is density^2 / dt.
  Matrix9 A = Matrix9::Identity();
  A.block<3, 3>(0, 0) = E.transpose();
  A.block<3, 3>(3, 0) = -R_a * dt;
  A.block<3, 3>(6, 0) = -0.5 * dt * dt * R_a;
  A.block<3, 3>(6, 3) = dt * Eigen::Matrix3d::Identity();
  covariance_ = (A * covariance_ * A.transpose()).eval();
  const auto variance = [dt](double density, double scale) {
    return density * density * scale * scale * dt;
  };
  const double gyro = variance(noise_.gyro_density, sample.noise_scale.gyro);
  const double accelerometer =
      variance(noise_.accelerometer_density, sample.noise_scale.accelerometer);
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  covariance_.block<3, 3>(0, 0) += gyro * J * J.transpose();
  covariance_.block<3, 3>(3, 3) += accelerometer * I;  // R I R' = I
  covariance_.block<3, 3>(3, 6) += 0.5 * dt * accelerometer * I;
  covariance_.block<3, 3>(6, 3) += 0.5 * dt * accelerometer * I;
  covariance_.block<3, 3>(6, 6) += 0.25 * dt * dt * accelerometer * I;

  // Bias Jacobians, ibid. appendix B; position before velocity before rotation.
  BiasJacobians& d = jacobians_;
  const Eigen::Matrix3d R_a_gyro = R_a * d.rotation_gyro;
  d.position_accelerometer += d.velocity_accelerometer * dt - 0.5 * dt * dt * R;
  d.position_gyro += d.velocity_gyro * dt - 0.5 * dt * dt * R_a_gyro;
  d.velocity_accelerometer -= R * dt;
  d.velocity_gyro -= R_a_gyro * dt;
  d.rotation_gyro = (E.transpose() * d.rotation_gyro - J * dt).eval();

  increments_.position += increments_.velocity * dt + 0.5 * dt * dt * (R * a);
  increments_.velocity += R * a * dt;
  increments_.rotation = R * E;
  seconds_ += dt;
}

Preintegration::Increments Preintegration::at(const Eigen::Vector3d& gyro_bias,
                                              const Eigen::Vector3d& accelerometer_bias) const {
  const Eigen::Vector3d d_gyro = gyro_bias - gyro_bias_;
  const Eigen::Vector3d d_accelerometer = accelerometer_bias - accelerometer_bias_;
  Increments moved = increments_;
  moved.rotation = increments_.rotation * exp_so3(jacobians_.rotation_gyro * d_gyro);
  moved.velocity +=
      jacobians_.velocity_gyro * d_gyro + jacobians_.velocity_accelerometer * d_accelerometer;
  moved.position +=
      jacobians_.position_gyro * d_gyro + jacobians_.position_accelerometer * d_accelerometer;
  return moved;
}

void Preintegration::reintegrate(const Eigen::Vector3d& gyro_bias,
                                 const Eigen::Vector3d& accelerometer_bias) {
  gyro_bias_ = gyro_bias;
  accelerometer_bias_ = accelerometer_bias;
  seconds_ = 0;
  increments_ = {};
  jacobians_ = {};
  covariance_.setZero();
  for (const Sample& sample : samples_) integrate(sample);
}

NavState Preintegration::predict(const NavState& start, const Eigen::Vector3d& gravity_map) const {
  const Increments moved = at(start.gyro_bias, start.accelerometer_bias);
  const Eigen::Matrix3d R = start.rotation();
  NavState end = start;
  end.stamp = geometry::shifted(start.stamp, seconds_);
  end.q_map_body = Eigen::Quaterniond(R * moved.rotation).normalized();
  end.p_map = start.p_map + start.v_map * seconds_ + 0.5 * seconds_ * seconds_ * gravity_map +
              R * moved.position;
  end.v_map = start.v_map + gravity_map * seconds_ + R * moved.velocity;
  return end;
}

}  // namespace traverse::inertial
