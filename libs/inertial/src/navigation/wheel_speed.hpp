#pragma once

#include <deque>
#include <optional>

#include "traverse/geometry/stamp.hpp"
#include "traverse/sensors/wheel_encoder.hpp"
#include "traverse/sensors/wheel_odometry.hpp"

namespace traverse::inertial {

/// Turns the wheels' readings into the forward speed at a state. Pulses tell the mean speed of an
/// interval that has passed; what the speed has changed by since, the IMU tells.
class WheelSpeed {
 public:
  /// \param standing_mps  speed below which wheels stand
  WheelSpeed(const std::optional<sensors::WheelEncoder>& encoder, double standing_mps)
      : encoder_(encoder), standing_mps_(standing_mps) {}

  /// False if it tells no speed: pulses of unknown meaning, or the first ones.
  bool add(const sensors::WheelOdometry& reading);
  /// The IMU's change of forward speed, added up [m/s].
  void add_change(geometry::Stamp stamp, double change_mps);

  /// The speed at `stamp` from the readings since the last call, which are then used up; nothing if
  /// there are none that are younger than kOldest.
  std::optional<double> take(geometry::Stamp stamp);
  /// The speed at an earlier moment from the readings that the last call took; nothing if that does
  /// not lie among them or there were none.
  std::optional<double> taken_at(geometry::Stamp stamp) const;
  /// Whether there is a reading that was not taken yet.
  bool is_fresh() const { return is_fresh_; }
  /// Of the last reading [m/s].
  double last() const { return mean_mps_; }
  /// How long every reading up to the last has told that the wheels stand.
  double standing_seconds() const;

  static constexpr double kOldest = 0.25;  ///< seconds

 private:
  struct Change {
    geometry::Stamp stamp;
    double sum_mps;
  };
  double change_at(geometry::Stamp stamp) const;
  double mean_change(geometry::Stamp from, geometry::Stamp to) const;

  std::optional<sensors::WheelEncoder> encoder_;
  double standing_mps_;
  std::deque<Change> changes_;
  std::optional<sensors::WheelOdometry> previous_;
  std::optional<geometry::Stamp> begin_;  ///< of the interval that was not taken yet
  geometry::Stamp end_;
  double distance_m_ = 0;  ///< in it
  bool is_fresh_ = false;
  bool is_instant_ = false;  ///< the readings are speeds, not distances
  double mean_mps_ = 0;
  std::optional<geometry::Stamp> slow_since_;
  struct Taken {
    geometry::Stamp stamp;
    double mps;
  };
  std::optional<Taken> taken_;  ///< what take() gave
};

}  // namespace traverse::inertial
