#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "traverse/sensors/measurement.hpp"

namespace traverse::simulation {

/// Sensors that give samples at fixed rates, merged in the order of their moments.
class SampleStreams {
 public:
  using Sample = std::function<std::optional<sensors::Measurement>(std::size_t)>;

  /// `sample` is asked for numbers 0, 1, .. in turn, number i being taken i / rate seconds into the
  /// drive and stamped `late` seconds later.
  void add(double rate_hz, double late_s, Sample sample);

  /// Gives `use` every sample stamped before `seconds` that has not been given yet.
  void give_until(double seconds, const std::function<void(sensors::Measurement&&)>& use);

 private:
  struct Stream {
    double rate_hz, late_s;
    Sample sample;
    std::size_t next = 0;

    double next_s() const { return static_cast<double>(next) / rate_hz + late_s; }
  };
  std::vector<Stream> streams_;
};

}  // namespace traverse::simulation
