#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "traverse/config/binder.hpp"
#include "traverse/geometry/pose3.hpp"
#include "traverse/slam/keyframe.hpp"
#include "traverse/voxel_map/voxel_map.hpp"

namespace traverse::slam {

/// The voxel map of planes and lines that some keyframes make, in the lidar frame of one of them.
struct Submap {
  std::size_t centre = 0;  ///< id of the keyframe whose frame it is
  std::size_t first = 0;   ///< the keyframes it is made of, both included
  std::size_t last = 0;
  voxel_map::VoxelMap map;
  double own_overlap = 1;  ///< share of its centre's points that lie on it: less among leaves
};

struct SubmapOptions {
  int keyframes_before = 6;  ///< of the submap's centre
  int keyframes_after = 6;
  voxel_map::VoxelMapOptions map;
};
void bind(config::Binder& binder, SubmapOptions& options);

/// A keyframe and where it stands in the frame of the submap's centre.
struct PlacedKeyframe {
  std::shared_ptr<const Keyframe> keyframe;
  geometry::Pose3 T_centre_lidar;
};

/// \param keyframes in order of their ids, not empty
Submap make_submap(std::size_t centre, std::span<const PlacedKeyframe> keyframes,
                   const voxel_map::VoxelMapOptions& options);

}  // namespace traverse::slam
