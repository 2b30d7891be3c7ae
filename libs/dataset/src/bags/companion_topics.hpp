#pragma once

#include <optional>
#include <string_view>
#include <utility>

#include "traverse/geometry/stamp.hpp"
#include "traverse/sensors/wheel_odometry.hpp"

namespace traverse::dataset {

/// Topics beside those of a receiver and of wheels, "/gnss/heading" beside "/gnss", whose messages
/// hold what no common message of ROS can. Each comes before the one of the same stamp that it
/// belongs to.
inline constexpr std::string_view kHeadingOfTopic = "/heading";
inline constexpr std::string_view kPulsesOfTopic = "/pulses";

/// What the last messages of such topics told and nobody has taken yet.
struct CompanionReadings {
  std::optional<std::pair<geometry::Stamp, double>> heading_deg;
  std::optional<std::pair<geometry::Stamp, sensors::WheelOdometry::Ticks>> pulses;
};

/// Takes what is of that moment.
template <typename Value>
std::optional<Value> take_of(std::optional<std::pair<geometry::Stamp, Value>>& reading,
                             geometry::Stamp stamp) {
  if (!reading || reading->first != stamp) return std::nullopt;
  Value value = reading->second;
  reading.reset();
  return value;
}

}  // namespace traverse::dataset
