#pragma once

#include <map>
#include <string>

#include "traverse/geometry/stamp.hpp"
#include "traverse/sensors/measurement.hpp"

namespace traverse::dataset {

/// Sees to it that the stamps of each sensor grow.
class StampOrder {
 public:
  static constexpr const char* kFault = "stamp not later than the one before";

  /// True, and remembered, if `stamp` is later than all that `sensor` had before.
  bool accept(const std::string& sensor, geometry::Stamp stamp) {
    const auto [last, is_first] = last_.try_emplace(sensor, stamp);
    if (is_first) return true;
    if (stamp <= last->second) return false;
    last->second = stamp;
    return true;
  }
  bool accept(const sensors::Measurement& measurement) {
    return accept(sensors::sensor_of(measurement), sensors::stamp_of(measurement));
  }

 private:
  std::map<std::string, geometry::Stamp> last_;
};

}  // namespace traverse::dataset
