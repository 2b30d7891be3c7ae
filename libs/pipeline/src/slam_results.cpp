#include "slam_results.hpp"

#include <span>
#include <vector>

#include "traverse/geometry/voxel_set.hpp"
#include "traverse/slam/slam.hpp"

namespace traverse::pipeline {

void WaitingForScore::add(std::size_t frame, const UsedScan& scan) {
  std::vector<float> x, y, z;
  // The score reduces again by the same cubes, of which these are the first points too.
  geometry::VoxelSet voxels(evaluation::consistency::kVoxel_m);
  for (std::size_t i = 0; i < scan.x.size(); ++i) {
    const Eigen::Vector3d p(scan.x[i], scan.y[i], scan.z[i]);
    const double range_m = p.norm();
    if (!(range_m >= evaluation::consistency::kLeastRange_m &&
          range_m <= evaluation::consistency::kMostRange_m)) {
      continue;
    }
    if (!voxels.insert(p)) continue;
    x.push_back(scan.x[i]);
    y.push_back(scan.y[i]);
    z.push_back(scan.z[i]);
  }
  const std::size_t points = x.size();
  x.insert(x.end(), y.begin(), y.end());
  x.insert(x.end(), z.begin(), z.end());
  scans_.push_back({frame, points, room_.append(std::as_bytes(std::span(x)))});
}

std::optional<evaluation::Consistency> WaitingForScore::score(
    const geometry::Trajectory& T_map_body, const std::string& points_are) const {
  evaluation::ConsistencyScorer scorer(points_are);
  std::vector<float> kept;
  for (const Scan& scan : scans_) {
    kept.resize(3 * scan.points);
    room_.read(scan.offset, std::as_writable_bytes(std::span(kept)));
    const std::span<const float> all(kept);
    scorer.add(all.first(scan.points), all.subspan(scan.points, scan.points), all.last(scan.points),
               T_map_body.pose(scan.frame));
  }
  return scorer.score();
}

namespace {

mapping::MapKeyframe in_body_frame(const slam::Keyframe& keyframe, const std::string& sensor,
                                   const geometry::Pose3& T_map_lidar,
                                   const geometry::Pose3& T_body_lidar) {
  mapping::MapKeyframe placed;
  placed.stamp = keyframe.stamp;
  placed.sensor = sensor;
  placed.T_map_body = T_map_lidar * T_body_lidar.inverse();
  placed.p_body_sensor = T_body_lidar.translation;
  const slam::KeyframePoints& points = keyframe.points;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Eigen::Vector3d p = T_body_lidar * Eigen::Vector3d(points.x[k], points.y[k], points.z[k]);
    placed.x.push_back(static_cast<float>(p.x()));
    placed.y.push_back(static_cast<float>(p.y()));
    placed.z.push_back(static_cast<float>(p.z()));
  }
  placed.intensity = points.intensity;
  placed.time = points.time;
  placed.ring = points.ring;
  return placed;
}

}  // namespace

void rebuild_maps(const SlamMap& slam_map, const std::string& sensor, mapping::VoxelMap& points,
                  mapping::KeyframeMap& keyframes) {
  const geometry::Pose3& T_body_lidar = slam_map.T_body_lidar();
  const slam::KeyframeStore& store = slam_map.slam().keyframes();
  for (std::size_t i = 0; i < store.size(); ++i) {
    const mapping::MapKeyframe placed =
        in_body_frame(*store.at(i), sensor, slam_map.optimised(i), T_body_lidar);
    points.insert(placed.x, placed.y, placed.z, placed.intensity, placed.T_map_body);
    keyframes.add(placed);
  }
}

}  // namespace traverse::pipeline
