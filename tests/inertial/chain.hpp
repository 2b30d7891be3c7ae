#pragma once

#include <memory>

#include "factors/gated_factor.hpp"
#include "factors/preintegration.hpp"
#include "residuals/gnss_position.hpp"
#include "smoother/fixed_lag_smoother.hpp"

namespace traverse::testing {

inline const Eigen::Vector3d kGravityMap(0, 0, -9.81);

/// Calibrations that hardly walk, so that what a test looks at is not hidden by them.
inline inertial::FixedLagSmoother smoother(const inertial::WindowOptions& options,
                                           const inertial::ImuNoise& noise = {}) {
  return {options, noise, {1e-5, 1e-6, 1e-5, Eigen::Vector3d::Constant(1e-5), 60}, kGravityMap};
}

/// Hardly any doubt but of the position.
inline inertial::NavState::Tangent sure_but_of_position(double sigma_m) {
  inertial::NavState::Tangent sigma = inertial::NavState::Tangent::Constant(1e-5);
  sigma.segment<3>(inertial::NavState::kPosition).setConstant(sigma_m);
  return sigma;
}

/// So many seconds at 100 Hz of a level IMU that neither turns nor speeds up, but errs by its
/// biases, integrated about those that `start` believes.
inline std::shared_ptr<inertial::Preintegration> coasting(
    double seconds, const inertial::NavState& start, const inertial::ImuNoise& noise = {},
    const Eigen::Vector3d& accelerometer_bias = Eigen::Vector3d::Zero()) {
  auto imu =
      std::make_shared<inertial::Preintegration>(noise, start.gyro_bias, start.accelerometer_bias);
  const int samples = static_cast<int>(std::lround(100 * seconds));
  for (int k = 0; k < samples; ++k) {
    imu->add(Eigen::Vector3d::Zero(), accelerometer_bias - kGravityMap, 0.01);
  }
  return imu;
}

/// A fix of an antenna at the body's origin.
inline std::unique_ptr<inertial::StateFactor> fix(const Eigen::Vector3d& p_map, double sigma_m,
                                                  double huber = 0) {
  return inertial::make_factor(inertial::GnssPositionResidual{{p_map, Eigen::Vector3d::Zero()}},
                               Eigen::Matrix3d(sigma_m * sigma_m * Eigen::Matrix3d::Identity()),
                               huber);
}

}  // namespace traverse::testing
