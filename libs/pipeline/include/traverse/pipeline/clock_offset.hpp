#pragma once

#include <optional>
#include <vector>

#include "traverse/geometry/stamp.hpp"
#include "traverse/geometry/trajectory.hpp"
#include "traverse/sensors/imu_sample.hpp"

namespace traverse::pipeline {

/// How far something has turned in all, about whatever axes: the integral of its angular speed.
struct TurnedAngle {
  std::vector<geometry::Stamp> stamps;  ///< ascending
  std::vector<double> angle_rad;        ///< one a stamp; the first is 0

  /// \param T_map_body with stamps
  static TurnedAngle of(const geometry::Trajectory& T_map_body);
  /// \param samples in the order of their stamps
  static TurnedAngle of(const std::vector<sensors::ImuSample>& samples);
};

/// By how much two clocks differ.
struct ClockOffset {
  double seconds = 0;      ///< to be added to the first one's stamps
  double correlation = 0;  ///< of the angular speeds after that, at most 1
  double runner_up = 0;    ///< the highest at another maximum
};

/// The offset at which the angular speeds of one body by two clocks go together best. Nothing
/// unless they do (correlation of at least 0.7, over at least half of the shorter one), and nowhere
/// else nearly as well (0.1): a body that hardly turns does not tell.
std::optional<ClockOffset> find_clock_offset(const TurnedAngle& first, const TurnedAngle& second);

}  // namespace traverse::pipeline
