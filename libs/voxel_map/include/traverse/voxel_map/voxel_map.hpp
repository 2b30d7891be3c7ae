#pragma once

#include <cstddef>

#include "traverse/parallel/workers.hpp"
#include "traverse/voxel_map/line_map.hpp"
#include "traverse/voxel_map/plane_map.hpp"
#include "traverse/voxel_map/sweep_sample.hpp"

namespace traverse::voxel_map {

struct VoxelMapOptions {
  PlaneMapOptions planes;
  LineMapOptions lines;
  double radius_m = 100;  ///< cells farther from the vehicle are dropped
};
void bind(config::Binder& binder, VoxelMapOptions& options);

/// The local map: planes where surfaces are, lines where they end. Memory is bounded by the radius.
class VoxelMap {
 public:
  explicit VoxelMap(const VoxelMapOptions& options);

  /// Adds a scan's points, deskewed by `velocity`; every tenth of the radius, cells out of reach
  /// go.
  void insert(const SweepSample& sample, const geometry::Pose3& T_map_lidar,
              const geometry::Twist& velocity, parallel::Workers& workers);

  const PlaneMap& planes() const { return planes_; }
  const LineMap& lines() const { return lines_; }
  std::size_t size() const { return planes_.size() + lines_.size(); }
  std::size_t bytes() const { return planes_.bytes() + lines_.bytes(); }

 private:
  VoxelMapOptions options_;
  PlaneMap planes_;
  LineMap lines_;
  Eigen::Vector3d last_centre_ = Eigen::Vector3d::Zero();
  LocalPoints surface_, edges_;  // kept for their memory
};

}  // namespace traverse::voxel_map
