#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "traverse/sensors/lidar_scan.hpp"

namespace traverse::plausibility {

/// A scan in a few numbers, from a thousand of its points.
struct ScanSummary {
  double t = 0;
  std::size_t points = 0;
  std::size_t looked_at = 0;
  std::size_t not_finite = 0;
  std::size_t at_origin = 0;
  std::size_t absurd = 0;  ///< a coordinate beyond 10 000 km, or not zero and below a micrometre
  double range_p05_m = 0;  ///< of the points that are somewhere; 0: there are none
  double range_median_m = 0;
  double range_p95_m = 0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< median coordinates
  double spread_m = 0;                               ///< median distance from there
  /// After how many of the stored numbers x y z intensity they are most alike: 4 of a scan that was
  /// read as it is stored; 0 where no number stands out.
  std::size_t columns = 0;
  std::optional<std::array<double, 2>> times_s;  ///< earliest and latest stored time
};

/// What a lidar said: the first scans, then every tenth, and at most so many as an hour holds.
class LidarTrack {
 public:
  void take(double t, const sensors::LidarScan& scan);

  const std::vector<ScanSummary>& scans() const { return scans_; }
  /// Of the first scans: median time from one to the next; nothing with fewer than two scans.
  std::optional<double> interval_s() const;

 private:
  std::vector<ScanSummary> scans_;
  std::vector<double> intervals_;
  std::optional<double> last_t_;
  std::size_t seen_ = 0;
};

}  // namespace traverse::plausibility
