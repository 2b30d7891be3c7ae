#pragma once

#include <deque>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "traverse/config/binder.hpp"
#include "traverse/sensors/imu_sample.hpp"

namespace traverse::inertial {

struct StandStillOptions {
  double seconds = 1;          ///< to stand still for
  double rate_std = 0.02;      ///< most standard deviation of the angular rate, an axis [rad/s]
  double force_std = 0.2;      ///< of the specific force [m/s^2]
  double rate = 0.1;           ///< most mean angular rate, which is taken for the bias [rad/s]
  double gravity_error = 0.5;  ///< most difference of the mean specific force to gravity [m/s^2]
};
void bind(config::Binder& binder, StandStillOptions& options);

/// What standing still tells about an IMU.
struct StandStill {
  Eigen::Vector3d gyro_bias;           ///< rad/s
  Eigen::Vector3d accelerometer_bias;  ///< only its part along gravity can be seen [m/s^2]
  double gyro_bias_sigma;              ///< standard error of the mean, the worst axis [rad/s]
  Eigen::Matrix3d R_level_body;        ///< roll and pitch; x stays in its vertical plane
};

/// Finds out whether a vehicle has been standing still up to now, from the spread of its IMU's
/// readings and, where there are wheels, from their not turning either way.
class StandStillFinder {
 public:
  /// \param gravity  positive [m/s^2]
  StandStillFinder(const StandStillOptions& options, double gravity);

  void add(const sensors::ImuSample& sample);
  void add_wheels(geometry::Stamp stamp, bool are_turning);

  /// Nothing if it has not; why_not() then tells.
  std::optional<StandStill> find() const;
  std::string why_not() const;

 private:
  struct Verdict {
    std::optional<StandStill> found;
    std::string why_not;
  };
  Verdict judge() const;

  StandStillOptions options_;
  double gravity_;
  std::deque<sensors::ImuSample> window_;  ///< of the last options_.seconds
  std::optional<geometry::Stamp> last_turning_;
};

/// The rotation that brings `up_body` to the z axis and keeps the x axis in its vertical plane.
Eigen::Matrix3d levelled(const Eigen::Vector3d& up_body);

}  // namespace traverse::inertial
