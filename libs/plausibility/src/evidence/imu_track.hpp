#pragma once

#include <optional>
#include <vector>

#include "traverse/sensors/imu_sample.hpp"

#include "evidence/accumulated.hpp"

namespace traverse::plausibility {

/// What an IMU said, in its own axes.
class ImuTrack {
 public:
  void take(double t, const sensors::ImuSample& sample);

  /// Integral of the angular rate [rad, if that is its unit].
  const Accumulated<3>& turn() const { return turn_; }
  /// Integral of the specific force.
  const Accumulated<3>& push() const { return push_; }
  /// Median time between samples [s]; nothing with fewer than three.
  std::optional<double> interval_s() const;
  std::size_t samples() const { return samples_; }

 private:
  Accumulated<3> turn_;
  Accumulated<3> push_;
  std::optional<double> last_t_;
  sensors::ImuSample last_;
  std::vector<double> intervals_;  ///< of the first samples
  std::size_t samples_ = 0;
};

}  // namespace traverse::plausibility
