#pragma once

#include "traverse/config/binder.hpp"

namespace traverse::inertial {

/// How an inertial unit errs: white noise as densities, which do not depend on the sampling rate,
/// and the walk of its biases. The defaults are those of a consumer unit.
struct ImuNoise {
  double gyro_density = 2e-4;             ///< rad/s/sqrt(Hz)
  double accelerometer_density = 2e-3;    ///< m/s^2/sqrt(Hz)
  double gyro_bias_walk = 2e-6;           ///< rad/s/sqrt(s)
  double accelerometer_bias_walk = 1e-4;  ///< m/s^2/sqrt(s)
  /// Readings that scatter by more than twice that are as noisy as they scatter. False where what
  /// they scatter by is the vehicle's own motion.
  bool shaking = true;
};

void bind(config::Binder& binder, ImuNoise& noise);

}  // namespace traverse::inertial
