#pragma once

#include <cstddef>
#include <vector>

#include "traverse/geometry/stamp.hpp"
#include "traverse/sensors/lidar_profile.hpp"

namespace traverse::sensors {

/// What the scans so far tell of the sweeps to come: how long from one to the next, and where
/// within a sweep its stamp is. A spinning head turns steadily, so intervals that scatter are
/// stamps of arrival, not motion of the head.
class SteadySweeps {
 public:
  explicit SteadySweeps(const LidarProfile& profile);

  /// \param first_s, last_s the times of the scan's first and last point after its stamp; equal
  /// where they are not known
  void learn(geometry::Stamp stamp, double first_s, double last_s);

  /// Seconds from one scan to the next. Where times come from the azimuth: scan_interval(). Where
  /// points bring their times and sweeps follow each other without a pause: a whole number of
  /// sweeps, if intervals scatter by more than 3 % (1.4826 MAD); else as stamped. The
  /// number is counted by a clock that follows the stamps slowly, so that one late scan is not
  /// taken for one that was lost.
  double interval(geometry::Stamp earlier, geometry::Stamp later) const;

  /// Whether a scan's times span less than half of what they usually do: they were not recorded,
  /// as where a driver gives one time to a whole scan.
  bool lacks_times(double first_s, double last_s) const;

  /// Seconds from the stamp to the middle of the sweep, the median of the scans so far.
  double usual_middle_s() const;

 private:
  static constexpr std::size_t kRemembered = 31;  // scans

  LidarProfile profile_;
  /// How many sweeps each remembered stamp is after the oldest one, when stamps scatter by
  /// `jitter_s` (standard deviation).
  std::vector<double> counted_sweeps(double period_s, double jitter_s) const;

  std::vector<geometry::Stamp> stamps_;  // the latest, oldest first
  std::vector<double> intervals_s_;
  std::vector<double> spans_s_;
  std::vector<double> middles_s_;
};

}  // namespace traverse::sensors
