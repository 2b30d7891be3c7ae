#include "traverse/voxel_map/voxel_map.hpp"

#include "traverse/parallel/workers.hpp"

namespace traverse::voxel_map {

void bind(config::Binder& b, VoxelMapOptions& o) {
  b.group("planes", "cells of planar points", [&](config::Binder& g) { bind(g, o.planes); });
  b.group("lines", "cells of edge points", [&](config::Binder& g) { bind(g, o.lines); });
  b.number("radius_m", o.radius_m, config::Range::between(10, 150),
           "cells farther away are dropped");
}

VoxelMap::VoxelMap(const VoxelMapOptions& options)
    : options_(options), planes_(options.planes), lines_(options.lines) {}

void VoxelMap::insert(const SweepSample& sample, const geometry::Pose3& T_map_lidar,
                      const geometry::Twist& velocity, parallel::Workers& workers) {
  to_local(sample.surface, T_map_lidar, velocity, workers, surface_);
  to_local(sample.edges, T_map_lidar, velocity, workers, edges_);
  planes_.insert(surface_, workers);
  lines_.insert(edges_);
  if ((T_map_lidar.translation - last_centre_).norm() < 0.1 * options_.radius_m) return;
  last_centre_ = T_map_lidar.translation;
  planes_.keep_near(last_centre_, options_.radius_m, workers);
  lines_.keep_near(last_centre_, options_.radius_m);
}

}  // namespace traverse::voxel_map
