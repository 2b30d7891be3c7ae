#include "traverse/packets/sensor_clock.hpp"

#include <cmath>
#include <cstdlib>

namespace traverse::packets {

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// a - b without overflow, for clocks of damaged packets.
std::int64_t apart_ns(std::int64_t a, std::int64_t b) {
  constexpr std::int64_t kFar = INT64_MAX / 4;
  if ((a > kFar && b < -kFar) || (a < -kFar && b > kFar)) return kFar;
  return a - b;
}

std::int64_t nearest_multiple(std::int64_t value, std::int64_t period) {
  const std::int64_t half = value >= 0 ? period / 2 : -(period / 2);
  return (value + half) / period * period;
}

}  // namespace

void SensorClock::begin(std::int64_t sensor_ns, geometry::Stamp arrival) {
  const std::int64_t apart = apart_ns(arrival.nanoseconds, sensor_ns);
  const std::int64_t whole = period_ns_ == 0 ? 0 : nearest_multiple(apart, period_ns_);
  is_absolute_ = std::llabs(apart - whole) <= kSecond_ns;
  offset_ns_ = is_absolute_ ? whole : apart;
}

SensorClock::Reading SensorClock::at(std::int64_t sensor_ns, geometry::Stamp arrival) {
  if (!offset_ns_) begin(sensor_ns, arrival);
  if (period_ns_ != 0) {
    const std::int64_t late = apart_ns(arrival.nanoseconds, sensor_ns + *offset_ns_);
    *offset_ns_ += nearest_multiple(late, period_ns_);
  }
  const std::int64_t late = apart_ns(arrival.nanoseconds, sensor_ns + *offset_ns_);
  const bool is_step = std::llabs(late) > 2 * kSecond_ns;
  if (is_step) {
    begin(sensor_ns, arrival);
    ++steps_;
  }
  return {geometry::Stamp{sensor_ns + *offset_ns_}, is_step};
}

}  // namespace traverse::packets
