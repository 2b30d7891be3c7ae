#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "traverse/sensors/imu_sample.hpp"

namespace traverse::fusion {

/// The readings of an IMU of the last moments, in the axes of the lidar.
class ImuReadings {
 public:
  /// One that is not finite or not later than the one before is left out and counted.
  void add(const sensors::ImuSample& reading);

  bool empty() const { return readings_.empty(); }
  /// Whether nothing that is still to come tells of a moment up to `stamp`.
  bool reach(geometry::Stamp stamp) const;

  /// Readings from one moment to another, with one at either: interpolated there, or the nearest
  /// where there are none on both sides. \pre !empty(), from < to
  std::vector<sensors::ImuSample> between(geometry::Stamp from, geometry::Stamp to) const;
  /// The longest time between `from` and `to` without a reading, seconds.
  double longest_gap_s(geometry::Stamp from, geometry::Stamp to) const;

  void forget_before(geometry::Stamp stamp);

  std::size_t left_out() const { return left_out_; }
  std::size_t bytes() const { return readings_.size() * sizeof(sensors::ImuSample); }

 private:
  sensors::ImuSample at(geometry::Stamp stamp) const;

  std::deque<sensors::ImuSample> readings_;
  std::size_t left_out_ = 0;
};

}  // namespace traverse::fusion
