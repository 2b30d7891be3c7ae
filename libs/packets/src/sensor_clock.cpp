#include "traverse/packets/sensor_clock.hpp"

#include <cstdint>
#include <cstdlib>

#include "saturated_sum.hpp"

namespace traverse::packets {

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

std::int64_t nearest_multiple(std::int64_t value, std::int64_t period) {
  const std::int64_t half = value >= 0 ? period / 2 : -(period / 2);
  return saturated_sum(value, half) / period * period;
}

}  // namespace

void SensorClock::begin(std::int64_t sensor_ns, geometry::Stamp arrival) {
  const std::int64_t apart = saturated_difference(arrival.nanoseconds, sensor_ns);
  const std::int64_t whole = period_ns_ == 0 ? 0 : nearest_multiple(apart, period_ns_);
  is_absolute_ = std::llabs(saturated_difference(apart, whole)) <= kSecond_ns;
  offset_ns_ = is_absolute_ ? whole : apart;
}

SensorClock::Reading SensorClock::at(std::int64_t sensor_ns, geometry::Stamp arrival) {
  if (!offset_ns_) begin(sensor_ns, arrival);
  if (period_ns_ != 0) {
    const std::int64_t late =
        saturated_difference(arrival.nanoseconds, saturated_sum(sensor_ns, *offset_ns_));
    offset_ns_ = saturated_sum(*offset_ns_, nearest_multiple(late, period_ns_));
  }
  const std::int64_t late =
      saturated_difference(arrival.nanoseconds, saturated_sum(sensor_ns, *offset_ns_));
  const bool is_step = std::llabs(late) > 2 * kSecond_ns;
  if (is_step) {
    begin(sensor_ns, arrival);
    ++steps_;
  }
  return {geometry::Stamp{saturated_sum(sensor_ns, *offset_ns_)}, is_step};
}

}  // namespace traverse::packets
