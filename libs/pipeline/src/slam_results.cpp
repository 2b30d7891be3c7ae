#include "slam_results.hpp"

#include <cmath>
#include <cstdint>
#include <tsl/robin_set.h>
#include <utility>

#include "traverse/geometry/voxel.hpp"
#include "traverse/slam/slam.hpp"

namespace traverse::pipeline {

void WaitingForScore::add(std::size_t frame, const UsedScan& scan) {
  Scan kept;
  kept.frame = frame;
  // The score reduces again by the same cubes, of which these are the first points too.
  tsl::robin_set<std::uint64_t, geometry::VoxelHash> occupied;
  for (std::size_t i = 0; i < scan.x.size(); ++i) {
    const Eigen::Vector3d p(scan.x[i], scan.y[i], scan.z[i]);
    const double range_m = p.norm();
    if (!(range_m >= evaluation::consistency::kLeastRange_m &&
          range_m <= evaluation::consistency::kMostRange_m)) {
      continue;
    }
    if (!occupied.insert(geometry::voxel_key(p, evaluation::consistency::kVoxel_m)).second) {
      continue;
    }
    kept.x.push_back(scan.x[i]);
    kept.y.push_back(scan.y[i]);
    kept.z.push_back(scan.z[i]);
  }
  scans_.push_back(std::move(kept));
}

std::optional<evaluation::Consistency> WaitingForScore::score(
    const geometry::Trajectory& T_map_body, const std::string& points_are) const {
  evaluation::ConsistencyScorer scorer(points_are);
  for (const Scan& scan : scans_) scorer.add(scan.x, scan.y, scan.z, T_map_body.pose(scan.frame));
  return scorer.score();
}

void rebuild_maps(const SlamMap& slam_map, const std::string& sensor, mapping::VoxelMap& points,
                  mapping::KeyframeMap& keyframes) {
  const geometry::Pose3& T_body_lidar = slam_map.T_body_lidar();
  const slam::KeyframeStore& store = slam_map.slam().keyframes();
  for (std::size_t i = 0; i < store.size(); ++i) {
    const auto keyframe = store.at(i);
    slam::KeyframePoints placed = keyframe->points;
    for (std::size_t k = 0; k < placed.size(); ++k) {
      const Eigen::Vector3d p =
          T_body_lidar * Eigen::Vector3d(placed.x[k], placed.y[k], placed.z[k]);
      placed.x[k] = static_cast<float>(p.x());
      placed.y[k] = static_cast<float>(p.y());
      placed.z[k] = static_cast<float>(p.z());
    }
    const geometry::Pose3 T_map_body = slam_map.optimised(i) * T_body_lidar.inverse();
    points.insert(placed.x, placed.y, placed.z, placed.intensity, T_map_body);
    keyframes.add(keyframe->stamp, sensor, placed.x, placed.y, placed.z, placed.intensity,
                  T_map_body, T_body_lidar.translation);
  }
}

}  // namespace traverse::pipeline
