#pragma once

#include <optional>

#include "traverse/sensors/wheel_encoder.hpp"
#include "traverse/sensors/wheel_odometry.hpp"

#include "evidence/accumulated.hpp"

namespace traverse::plausibility {

/// What wheels said.
class WheelTrack {
 public:
  void take(double t, const sensors::WheelOdometry& reading,
            const std::optional<sensors::WheelEncoder>& encoder);

  /// Three readings of one distance [m]: counts as they were read; counts that are in truth sums of
  /// counts (so that their differences are counts); sums that are in truth counts.
  enum Reading { kAsRead = 0, kSumsForCounts = 1, kCountsForSums = 2 };
  const Accumulated<3>& distance() const { return distance_; }
  /// Counterclockwise turn [rad], where the readings tell one.
  const Accumulated<1>& turn() const { return turn_; }
  bool has_pulses() const { return has_pulses_; }

 private:
  std::optional<Eigen::Vector3d> advance(const sensors::WheelOdometry& reading, double dt,
                                         const sensors::WheelEncoder& encoder);

  Accumulated<3> distance_;
  Accumulated<1> turn_;
  bool has_pulses_ = false;
  std::optional<double> last_t_;
  sensors::WheelOdometry last_;
  std::optional<double> last_count_m_;
};

}  // namespace traverse::plausibility
