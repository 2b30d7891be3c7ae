#pragma once

#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "traverse/config/binder.hpp"
#include "traverse/sensors/imu_sample.hpp"
#include "traverse/simulation/counter_noise.hpp"
#include "traverse/simulation/mounting.hpp"
#include "traverse/simulation/vehicle_motion.hpp"

namespace traverse::simulation {

constexpr double kGravity = 9.81;  ///< m/s^2, downwards along the map's z

/// Errors of an IMU. Densities are continuous: a sample's standard deviation is density sqrt(rate).
struct ImuSettings {
  bool mounted = true;
  Mounting mounting{0.6, 0.1, 0.5, 0, 0, 0};
  double rate_hz = 100;
  double gyro_noise = 1e-4;        ///< rad/s/sqrt(Hz)
  double accel_noise = 1e-3;       ///< m/s^2/sqrt(Hz)
  double gyro_bias_walk = 2e-6;    ///< rad/s^2/sqrt(Hz)
  double accel_bias_walk = 3e-5;   ///< m/s^3/sqrt(Hz)
  double gyro_bias = 2e-3;         ///< standard deviation at switch-on, rad/s
  double accel_bias = 0.03;        ///< standard deviation at switch-on, m/s^2
  double scale_error = 5e-4;       ///< standard deviation, each axis
  double misalignment_deg = 0.05;  ///< standard deviation, each axis against each other
  /// What a small vehicle on stiff wheels shakes it by while it drives, standard deviations of each
  /// reading: beyond half the rate, so white.
  double shaking_mps2 = 0;
  double shaking_rads = 0;
};
void bind(config::Binder& binder, ImuSettings& settings);

/// What an IMU reads: y = M x + b(t) + n, M = I + scale and misalignment, b a random walk. A sample
/// is the reading at its stamp.
class ImuSimulator {
 public:
  /// `motion` must outlive this.
  ImuSimulator(const ImuSettings& settings, const VehicleMotion& motion, std::uint64_t seed);

  /// Without errors, `seconds` into the drive.
  sensors::ImuSample exact(double seconds) const;
  /// Sample `i`, i / rate seconds into the drive; to be asked for in order, because the bias walks.
  sensors::ImuSample sample(std::size_t i);

  /// The errors that stay: what a calibration would find.
  struct Calibration {
    Eigen::Matrix3d gyro_matrix, accel_matrix;
    Eigen::Vector3d gyro_bias, accel_bias;  ///< at switch-on
  };
  const Calibration& calibration() const { return calibration_; }

 private:
  ImuSettings settings_;
  const VehicleMotion& motion_;
  geometry::Pose3 T_body_imu_;
  CounterNoise noise_;
  Calibration calibration_;
  Eigen::Vector3d gyro_walk_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_walk_ = Eigen::Vector3d::Zero();
};

}  // namespace traverse::simulation
