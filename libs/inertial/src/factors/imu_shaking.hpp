#pragma once

#include <deque>
#include <optional>

#include <Eigen/Core>

#include "traverse/inertial/imu_noise.hpp"
#include "traverse/sensors/imu_sample.hpp"

#include "factors/preintegration.hpp"

namespace traverse::inertial {

/// How much noisier an IMU is than its data sheet says while the vehicle shakes it.
///
/// A small robot on stiff wheels shakes its IMU by 1 m/s^2 from one reading to the next: what of it
/// is beyond half the rate, and what each reading misses of the time between two, is noise of the
/// integral. The second difference of readings takes constant motion and steady changes away and
/// leaves that noise, 6 times its variance. Below twice what is told nothing is changed: a
/// vehicle's own motion is in it too. What a road does to a car on its springs is such motion at
/// every frequency, and no noise: ImuNoise::shaking says so where a preset knows.
class ImuShaking {
 public:
  struct Densities {
    double gyro = 0;           ///< rad/s/sqrt(Hz)
    double accelerometer = 0;  ///< m/s^2/sqrt(Hz)
  };

  explicit ImuShaking(const ImuNoise& noise) : noise_(noise) {}

  /// Readings in the order of their stamps.
  void add(const sensors::ImuSample& sample);

  /// Of the readings just now.
  Preintegration::NoiseScale scale() const;
  /// The largest that were told in place of the IMU's own; nothing where none were.
  const std::optional<Densities>& most() const { return most_; }

 private:
  struct Squares {
    double gyro = 0;  ///< of a reading's noise, mean of the axes
    double accelerometer = 0;
    double seconds = 0;  ///< between readings
  };
  ImuNoise noise_;
  std::deque<sensors::ImuSample> last_;
  std::deque<Squares> squares_;
  Densities now_;
  std::optional<Densities> most_;
};

}  // namespace traverse::inertial
