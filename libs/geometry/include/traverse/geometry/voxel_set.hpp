#pragma once

#include <cstddef>
#include <memory>

#include <Eigen/Core>

namespace traverse::geometry {

/// The voxels in which points were seen, which tells the first point of each from those that
/// follow: what thins scans, maps and pictures to one point a voxel. Voxels are those of voxel_key.
class VoxelSet {
 public:
  /// \param edge_m of a voxel [m]
  /// \param points for which room is made at once; more can be inserted
  explicit VoxelSet(double edge_m, std::size_t points = 0);
  VoxelSet(VoxelSet&&) noexcept;
  VoxelSet& operator=(VoxelSet&&) noexcept;
  ~VoxelSet();

  /// \returns whether `p` is the first point of its voxel
  bool insert(const Eigen::Vector3d& p);

  std::size_t size() const;

 private:
  struct Keys;

  double edge_m_;
  std::unique_ptr<Keys> keys_;
};

}  // namespace traverse::geometry
