#pragma once

#include <cstddef>
#include <cstdint>

#include "traverse/config/binder.hpp"
#include "traverse/sensors/wheel_odometry.hpp"
#include "traverse/simulation/counter_noise.hpp"
#include "traverse/simulation/vehicle_motion.hpp"

namespace traverse::simulation {

/// The pulse counters of the two rear wheels.
struct WheelSettings {
  bool mounted = true;
  double rate_hz = 50;
  double radius_m = 0.32;
  double track_m = 1.55;  ///< between the wheels
  double pulses_per_turn = 1000;
  double radius_error = 0.003;   ///< standard deviation of a wheel's radius, relative
  double slip_per_mps2 = 0.003;  ///< share of the way that a wheel turns too far, by acceleration
  double roughness = 0.002;  ///< standard deviation of the way of a wheel between samples, relative
};
void bind(config::Binder& binder, WheelSettings& settings);

/// What wheel odometry reports: whole pulses since the start of the drive, speed and yaw rate from
/// the last two counts, and the pose dead-reckoned from them with the nominal radius.
class WheelSimulator {
 public:
  /// `motion` must outlive this.
  WheelSimulator(const WheelSettings& settings, const VehicleMotion& motion, std::uint64_t seed);

  /// The next sample; sample i is taken i / rate seconds into the drive.
  sensors::WheelOdometry next();

  /// Metres that each wheel rolls over the ground, without errors.
  struct Ways {
    double left, right;
  };
  Ways exact_ways(double from_s, double to_s) const;

 private:
  void reckon(std::int64_t left, std::int64_t right, sensors::WheelOdometry& odometry);

  WheelSettings settings_;
  const VehicleMotion& motion_;
  CounterNoise noise_;
  double left_radius_, right_radius_;
  std::size_t count_ = 0;
  double left_turns_ = 0, right_turns_ = 0;
  sensors::WheelOdometry::Ticks ticks_;
  geometry::Pose3 T_odom_body_;
};

}  // namespace traverse::simulation
