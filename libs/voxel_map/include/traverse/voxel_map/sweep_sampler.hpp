#pragma once

#include "traverse/geometry/stamp.hpp"
#include "traverse/parallel/workers.hpp"
#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"
#include "traverse/sensors/steady_sweeps.hpp"
#include "traverse/voxel_map/sweep_sample.hpp"

namespace traverse::voxel_map {

/// Samples the scans of one lidar, one after the other, and knows when the middles of their sweeps
/// were.
class SweepSampler {
 public:
  /// \param deskews  whether times within a sweep matter
  SweepSampler(const SamplingOptions& options, const sensors::LidarProfile& profile, bool deskews);

  /// The sample of the scan, with times from the middle of its sweep where it is deskewed.
  SweepSample sample(const sensors::LidarScan& scan, parallel::Workers& workers);

  /// Seconds between the middles of two sweeps, of which the earlier was `earlier_middle_s` after
  /// its stamp; the usual interval where stamps do not grow.
  double interval(geometry::Stamp earlier, double earlier_middle_s, const SweepSample& later) const;

 private:
  SamplingOptions options_;
  sensors::LidarProfile profile_;
  bool deskews_;
  sensors::SteadySweeps sweeps_;
};

}  // namespace traverse::voxel_map
