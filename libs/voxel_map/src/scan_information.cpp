#include "traverse/voxel_map/scan_information.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "traverse/lidar/stopwatch.hpp"
#include "traverse/statistics/quantile.hpp"

#include "facing_information.hpp"

namespace traverse::voxel_map {

namespace {

/// Of the mean information of a match: above it no noise of normals comes near.
constexpr double kPlainlySeen = 0.05;

/// The information of the matches on the body twist, rotation in units of `scale_m`, a match's
/// mean.
lidar::Matrix6 mean_information(const NormalEquations& normal, const Eigen::Matrix3d& R_map_lidar,
                                double scale_m) {
  lidar::Matrix6 axes = lidar::Matrix6::Identity();
  axes.topLeftCorner<3, 3>() /= scale_m;
  axes.bottomRightCorner<3, 3>() = R_map_lidar;
  return axes.transpose() * normal.H * axes / normal.weight;
}

double facing_along(const lidar::Observability& seen, int direction, const ScanMatches& matches,
                    const geometry::Pose3& T_map_lidar, const MotionModel& motion) {
  lidar::Vector6 along = seen.directions.col(direction);
  along.head<3>() /= seen.rotation_scale_m;
  return facing_information(matches, T_map_lidar, motion, along);
}

}  // namespace

void associate_at(const SweepSample& sample, const geometry::Pose3& T_map_lidar,
                  const MotionModel& motion, const VoxelMap& map, double gate_m,
                  const MatchOptions& options, parallel::Workers& workers, MovedSample& moved,
                  ScanMatches& matches, lidar::StageTimes& ms) {
  lidar::Stopwatch watch;
  const geometry::Twist velocity = motion.velocity_at(T_map_lidar);
  to_local(sample.planar, T_map_lidar, velocity, workers, moved.planar);
  to_local(sample.edges, T_map_lidar, velocity, workers, moved.edges);
  watch.lap(ms.deskew);
  associate(sample, moved.planar, moved.edges, map, gate_m, options, workers, matches);
  watch.lap(ms.associate);
}

double usual_range_m(const SweepSample& sample) {
  std::vector<float> ranges = sample.planar.range;
  return ranges.empty() ? 1 : statistics::element_at_share(ranges, 0.5);
}

lidar::Observability judged_observability(const NormalEquations& normal, const ScanMatches& matches,
                                          const geometry::Pose3& T_map_lidar,
                                          const MotionModel& motion, double scale_m,
                                          double min_eigenvalue) {
  lidar::Observability seen =
      lidar::observability(mean_information(normal, T_map_lidar.rotation, scale_m), scale_m,
                           std::numeric_limits<double>::lowest());
  const auto is_degenerate = [&](int direction) {
    if (seen.eigenvalues[direction] > kPlainlySeen) return false;
    return facing_along(seen, direction, matches, T_map_lidar, motion) < min_eigenvalue;
  };
  while (seen.degenerate < 6 && is_degenerate(seen.degenerate)) ++seen.degenerate;
  return seen;
}

lidar::Vector6 facing_shares(const lidar::Observability& seen, const ScanMatches& matches,
                             const geometry::Pose3& T_map_lidar, const MotionModel& motion) {
  lidar::Vector6 shares = lidar::Vector6::Ones();
  for (int k = 0; k < 6; ++k) {
    if (k < seen.degenerate) {
      shares[k] = 0;
    } else if (seen.eigenvalues[k] <= kPlainlySeen) {
      const double facing = facing_along(seen, k, matches, T_map_lidar, motion);
      shares[k] = std::min(1.0, facing / seen.eigenvalues[k]);
    }
  }
  return shares;
}

}  // namespace traverse::voxel_map
