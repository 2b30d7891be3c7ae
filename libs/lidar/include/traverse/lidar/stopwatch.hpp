#pragma once

#include <chrono>
#include <utility>

namespace traverse::lidar {

/// Adds the milliseconds between its construction (or last lap) and now to a stage's time.
class Stopwatch {
 public:
  void lap(double& stage_ms) {
    const auto now = std::chrono::steady_clock::now();
    stage_ms += std::chrono::duration<double, std::milli>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace traverse::lidar
