#include "traverse/mapping/voxel_map.hpp"

#include <stdexcept>
#include <utility>

#include "traverse/dataset/point_cloud_file.hpp"

namespace traverse::mapping {

VoxelMap::VoxelMap(double voxel_m, std::size_t max_points)
    : voxel_m_(voxel_m), max_points_(max_points), occupied_(voxel_m) {}

void VoxelMap::insert(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                      std::span<const float> intensity, const geometry::Pose3& T_map_body) {
  if (y.size() != x.size() || z.size() != x.size() ||
      (!intensity.empty() && intensity.size() != x.size())) {
    throw std::invalid_argument("the arrays of a scan differ in size");
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    add(T_map_body * Eigen::Vector3d(x[i], y[i], z[i]), intensity.empty() ? 0 : intensity[i]);
  }
  if (points_.size() > max_points_) coarsen();
}

void VoxelMap::add(const Eigen::Vector3d& p_map, float intensity) {
  if (!occupied_.insert(p_map)) return;
  points_.push_back(p_map.cast<float>());
  intensities_.push_back(intensity);
}

void VoxelMap::coarsen() {
  const std::vector<Eigen::Vector3f> points = std::exchange(points_, {});
  const std::vector<float> intensities = std::exchange(intensities_, {});
  voxel_m_ *= 2;
  occupied_ = geometry::VoxelSet(voxel_m_);
  for (std::size_t i = 0; i < points.size(); ++i) {
    add(points[i].cast<double>(), intensities[i]);
  }
}

void VoxelMap::write_ply(const std::filesystem::path& file) const {
  std::vector<float> x, y, z;
  for (auto* values : {&x, &y, &z}) values->reserve(points_.size());
  for (const Eigen::Vector3f& p : points_) {
    x.push_back(p.x());
    y.push_back(p.y());
    z.push_back(p.z());
  }
  dataset::PointCloud cloud;
  cloud.add("x", std::move(x));
  cloud.add("y", std::move(y));
  cloud.add("z", std::move(z));
  cloud.add("intensity", intensities_);
  dataset::write_ply(file, cloud);
}

}  // namespace traverse::mapping
