#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/voxel_set.hpp"

namespace traverse::mapping {

/// The map that a run leaves behind: of all points that fell into a voxel the first one. Memory is
/// bounded: when there are more points than allowed, the voxels double and the map is thinned.
class VoxelMap {
 public:
  /// \param voxel_m edge of a voxel at first  \param max_points above it the voxels double
  VoxelMap(double voxel_m, std::size_t max_points);

  /// Adds the points of a scan in the body frame, metres.
  /// \param intensity one a point, or empty
  /// \throws std::invalid_argument if the arrays differ in size
  void insert(std::span<const float> x, std::span<const float> y, std::span<const float> z,
              std::span<const float> intensity, const geometry::Pose3& T_map_body);

  std::size_t size() const { return points_.size(); }
  double voxel_m() const { return voxel_m_; }
  /// Map frame, metres, in the order of arrival.
  const std::vector<Eigen::Vector3f>& points() const { return points_; }
  /// One a point; 0 where the scan had none.
  const std::vector<float>& intensities() const { return intensities_; }

  /// Writes x, y, z and intensity as binary PLY. \throws files::OutputError
  void write_ply(const std::filesystem::path& file) const;

 private:
  void add(const Eigen::Vector3d& p_map, float intensity);
  void coarsen();

  double voxel_m_;
  std::size_t max_points_;
  std::vector<Eigen::Vector3f> points_;
  std::vector<float> intensities_;
  geometry::VoxelSet occupied_;
};

}  // namespace traverse::mapping
