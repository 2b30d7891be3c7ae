#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "traverse/geometry/stamp.hpp"
#include "traverse/sensors/measurement.hpp"

namespace traverse::pipeline {

/// Counts what the recording gives, by sensor, and the time that it covers.
class ReadingCount {
 public:
  void add(const sensors::Measurement& measurement) {
    ++by_sensor_[sensors::sensor_of(measurement)];
    ++total_;
    const geometry::Stamp stamp = sensors::stamp_of(measurement);
    if (!first_ || stamp < *first_) first_ = stamp;
    if (!last_ || stamp > *last_) last_ = stamp;
  }

  std::size_t of(const std::string& sensor) const {
    const auto found = by_sensor_.find(sensor);
    return found == by_sensor_.end() ? 0 : found->second;
  }
  std::size_t total() const { return total_; }
  const std::optional<geometry::Stamp>& first() const { return first_; }
  const std::optional<geometry::Stamp>& last() const { return last_; }

 private:
  std::map<std::string, std::size_t> by_sensor_;
  std::size_t total_ = 0;
  std::optional<geometry::Stamp> first_;
  std::optional<geometry::Stamp> last_;
};

}  // namespace traverse::pipeline
