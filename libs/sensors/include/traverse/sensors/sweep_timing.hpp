#pragma once

#include <cstddef>
#include <vector>

#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"

namespace traverse::sensors {

/// Share of the sweep that is over when the head looks at `azimuth` [rad, counterclockwise from
/// ahead], in [0, 1). For a Velodyne on KITTI this is 0.5 (1 - atan2(y, x) / pi).
double sweep_fraction(double azimuth, const LidarProfile& profile);

/// The time of any point of a scan, found when asked: most points of a scan never need theirs.
/// Refers to the scan and the profile, which must outlive it.
class PointClock {
 public:
  PointClock(const LidarScan& scan, const LidarProfile& profile);

  /// False when the recording gives no way to know (source none, or data without times).
  bool knows() const { return knows_; }

  /// Seconds from the scan's stamp to point `i`, negative before. Only when knows().
  float operator()(std::size_t i) const;

 private:
  const LidarScan& scan_;
  const LidarProfile& profile_;
  bool knows_;
};

/// Seconds from one scan to the next. A head that turns steadily yields one scan a revolution, so
/// when times come from the azimuth and the stamps are within a quarter revolution of a whole
/// number of sweeps, that number of sweeps is the interval: recordings stamp scans on arrival, with
/// jitter (10 ms in KITTI's synchronised drives) that would pass for acceleration. Otherwise the
/// stamps say.
double scan_interval(geometry::Stamp earlier, geometry::Stamp later, const LidarProfile& profile);

/// The time of every point in seconds after the stamp; empty when the clock does not know.
std::vector<float> point_times(const LidarScan& scan, const LidarProfile& profile);

}  // namespace traverse::sensors
