#include "traverse/mapping/map_points.hpp"

#include <tsl/robin_set.h>

#include <Eigen/Dense>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/geometry/voxel.hpp"

namespace traverse::mapping {

MapPoints map_points(std::span<const MapKeyframe> keyframes, double voxel_m) {
  MapPoints points;
  tsl::robin_set<std::uint64_t, geometry::VoxelHash> occupied;
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const MapKeyframe& keyframe = keyframes[k];
    for (std::size_t i = 0; i < keyframe.size(); ++i) {
      const Eigen::Vector3d p = keyframe.T_map_body * keyframe.p_body(i);
      if (!occupied.insert(geometry::voxel_key(p, voxel_m)).second) continue;
      points.x.push_back(static_cast<float>(p.x()));
      points.y.push_back(static_cast<float>(p.y()));
      points.z.push_back(static_cast<float>(p.z()));
      points.intensity.push_back(keyframe.intensity.empty() ? 0 : keyframe.intensity[i]);
      points.time.push_back(keyframe.stamp.seconds());
      points.keyframe.push_back(static_cast<std::uint32_t>(k));
    }
  }
  return points;
}

void write_ply(const std::filesystem::path& file, const MapPoints& points, bool with_attributes) {
  dataset::PointCloud cloud;
  cloud.add("x", points.x);
  cloud.add("y", points.y);
  cloud.add("z", points.z);
  cloud.add("intensity", points.intensity);
  if (with_attributes) {
    cloud.add("time", points.time);
    cloud.add("keyframe", points.keyframe);
  }
  dataset::write_ply(file, cloud);
}

}  // namespace traverse::mapping
