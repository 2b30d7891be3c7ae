#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "traverse/sensors/gnss_fix.hpp"

namespace traverse::plausibility {

/// A fix, with its time in seconds.
struct TimedFix {
  double t = 0;
  double latitude = 0;  ///< degrees, if the recording is right
  double longitude = 0;
  double altitude_m = 0;
  std::optional<double> heading;  ///< degrees clockwise from north, if the recording is right
};

/// What a receiver said: at most twelve fixes a second of the first hour.
class GnssTrack {
 public:
  void take(double t, const sensors::GnssFix& fix);

  /// Those that are somewhere: neither 0 0 nor without a number.
  const std::vector<TimedFix>& fixes() const { return fixes_; }
  std::size_t at_zero() const { return at_zero_; }  ///< fixes at latitude and longitude 0

 private:
  std::vector<TimedFix> fixes_;
  std::size_t at_zero_ = 0;
};

}  // namespace traverse::plausibility
