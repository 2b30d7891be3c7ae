#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "traverse/inertial/imu_noise.hpp"
#include "traverse/inertial/nav_state.hpp"

namespace traverse::inertial {

/// The IMU samples between two moments as one relative motion: what an unaccelerated, unturned
/// observer who starts with the body would measure without gravity, its covariance, and how it
/// changes with the biases. Source: Forster et al., "On-manifold preintegration for real-time
/// visual-inertial odometry", T-RO 2017, sections VI-A to VI-C.
class Preintegration {
 public:
  using Matrix9 = Eigen::Matrix<double, 9, 9>;

  /// Of the three increments, in the frame of the body at the start.
  struct Increments {
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  };

  /// Derivatives of the increments in the biases: of the rotation on its right.
  struct BiasJacobians {
    Eigen::Matrix3d rotation_gyro = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d velocity_gyro = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d velocity_accelerometer = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d position_gyro = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d position_accelerometer = Eigen::Matrix3d::Zero();
  };

  /// \param gyro_bias, accelerometer_bias  the values to integrate about [rad/s], [m/s^2]
  Preintegration(const ImuNoise& noise, const Eigen::Vector3d& gyro_bias,
                 const Eigen::Vector3d& accelerometer_bias);

  /// By how much noisier than usual readings are: of a gap, many times.
  struct NoiseScale {
    double gyro = 1;
    double accelerometer = 1;
  };

  /// Adds a stretch of `seconds` of constant readings [rad/s], [m/s^2].
  /// \throws std::invalid_argument unless seconds > 0 and every number is finite.
  void add(const Eigen::Vector3d& angular_rate, const Eigen::Vector3d& specific_force,
           double seconds, const NoiseScale& noise_scale);
  void add(const Eigen::Vector3d& angular_rate, const Eigen::Vector3d& specific_force,
           double seconds) {
    add(angular_rate, specific_force, seconds, NoiseScale());
  }

  /// Makes one sample two of half the length, so that the covariance has full rank.
  void split_single_sample();

  double seconds() const { return seconds_; }
  std::size_t samples() const { return samples_.size(); }
  /// One sample gives a covariance of rank 6 only: at least two are needed to constrain a state.
  bool is_usable() const { return samples_.size() >= 2; }

  const Increments& increments() const { return increments_; }
  const BiasJacobians& bias_jacobians() const { return jacobians_; }
  /// Of (rotation, velocity, position) [rad, m/s, m], in this order.
  const Matrix9& covariance() const { return covariance_; }
  const Eigen::Vector3d& gyro_bias() const { return gyro_bias_; }
  const Eigen::Vector3d& accelerometer_bias() const { return accelerometer_bias_; }

  /// The increments at other biases, to first order (Forster et al., eq. 44).
  Increments at(const Eigen::Vector3d& gyro_bias, const Eigen::Vector3d& accelerometer_bias) const;

  /// Integrates the samples again about other biases.
  void reintegrate(const Eigen::Vector3d& gyro_bias, const Eigen::Vector3d& accelerometer_bias);

  /// The state after this motion from `start`, biases and scale carried over.
  /// \param gravity_map  of the map frame, (0, 0, -9.8) [m/s^2]
  NavState predict(const NavState& start, const Eigen::Vector3d& gravity_map) const;

 private:
  struct Sample {
    Eigen::Vector3d angular_rate;
    Eigen::Vector3d specific_force;
    double seconds;
    NoiseScale noise_scale;
  };

  void integrate(const Sample& sample);

  ImuNoise noise_;
  Eigen::Vector3d gyro_bias_;
  Eigen::Vector3d accelerometer_bias_;
  std::vector<Sample> samples_;
  double seconds_ = 0;
  Increments increments_;
  BiasJacobians jacobians_;
  Matrix9 covariance_ = Matrix9::Zero();
};

}  // namespace traverse::inertial
