#pragma once

#include <cstddef>
#include <string>

#include "traverse/sensors/rig.hpp"

namespace traverse::pipeline {

/// What became of the readings of one sensor.
struct SensorUse {
  std::string label;
  sensors::SensorKind kind = sensors::SensorKind::kLidar;
  /// The estimator takes such readings; else it is none of its sensors.
  bool is_taken = true;
  std::size_t read = 0;      ///< that the recording gave; 0 where it was not counted
  std::size_t used = 0;      ///< the estimate rests on them
  std::size_t rejected = 0;  ///< looked at and left out, because they contradict the estimate
  std::string reason = {};   ///< why some were not used, in words; empty if there is nothing to say
  double longest_rejected_s = 0;  ///< the longest time in which all that came were rejected

  /// Neither used nor rejected.
  std::size_t unused() const { return read > used + rejected ? read - used - rejected : 0; }
  /// Of those that were looked at; 0 if none was.
  double rejected_share() const {
    const std::size_t looked_at = used + rejected;
    return looked_at > 0 ? static_cast<double>(rejected) / static_cast<double>(looked_at) : 0;
  }
};

}  // namespace traverse::pipeline
