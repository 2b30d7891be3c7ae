#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "traverse/geometry/stamp.hpp"

namespace traverse::packets {

/// Brings the clock of a sensor to that of the recording. A clock that agrees with the arrivals to
/// a second is kept as it is (after the hour that a Velodyne does not tell); another is moved by
/// what the first packet shows, so that times between packets stay those of the sensor.
class SensorClock {
 public:
  /// \param period_ns after which the sensor's clock begins again; 0: never
  explicit SensorClock(std::int64_t period_ns = 0) : period_ns_(period_ns) {}

  struct Reading {
    geometry::Stamp stamp;
    bool is_step = false;  ///< the sensor's clock was set since the packet before
  };
  Reading at(std::int64_t sensor_ns, geometry::Stamp arrival);

  /// Whether the sensor's clock told the stamps' absolute time.
  bool is_absolute() const { return is_absolute_; }
  std::size_t steps() const { return steps_; }

 private:
  void begin(std::int64_t sensor_ns, geometry::Stamp arrival);

  std::int64_t period_ns_;
  std::optional<std::int64_t> offset_ns_;
  bool is_absolute_ = false;
  std::size_t steps_ = 0;
};

}  // namespace traverse::packets
