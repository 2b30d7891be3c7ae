#include "map_points.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Dense>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/geometry/voxel_set.hpp"

namespace traverse::mapping {

namespace {

/// A point of a keyframe that does not know times was seen at its stamp.
double time_of(const MapKeyframe& keyframe, std::size_t i) {
  return keyframe.time.empty() ? 0 : keyframe.time[i];
}

}  // namespace

MapPoints map_points(std::span<const MapKeyframe> keyframes, double voxel_m) {
  MapPoints points;
  geometry::VoxelSet voxels(voxel_m);
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const MapKeyframe& keyframe = keyframes[k];
    for (std::size_t i = 0; i < keyframe.size(); ++i) {
      const Eigen::Vector3d p = keyframe.T_map_body * keyframe.p_body(i);
      if (!voxels.insert(p)) continue;
      points.x.push_back(static_cast<float>(p.x()));
      points.y.push_back(static_cast<float>(p.y()));
      points.z.push_back(static_cast<float>(p.z()));
      points.intensity.push_back(keyframe.intensity.empty() ? 0 : keyframe.intensity[i]);
      points.stamp.push_back(geometry::shifted(keyframe.stamp, time_of(keyframe, i)));
      points.ring.push_back(keyframe.ring.empty() ? MapPoints::kNoRing : keyframe.ring[i]);
      points.keyframe.push_back(static_cast<std::uint32_t>(k));
      points.run.push_back(keyframe.run);
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
    std::vector<double> time;
    time.reserve(points.size());
    for (const geometry::Stamp stamp : points.stamp) time.push_back(stamp.seconds());
    cloud.add("time", std::move(time));
    const bool knows_rings = std::any_of(points.ring.begin(), points.ring.end(),
                                         [](auto ring) { return ring != MapPoints::kNoRing; });
    if (knows_rings) cloud.add("ring", points.ring);
    cloud.add("keyframe", points.keyframe);
  }
  dataset::write_ply(file, cloud);
}

}  // namespace traverse::mapping
