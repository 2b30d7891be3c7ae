#include "traverse/slam/submap.hpp"

#include "traverse/parallel/workers.hpp"

namespace traverse::slam {

void bind(config::Binder& b, SubmapOptions& o) {
  using config::Range;
  b.integer("keyframes_before", o.keyframes_before, Range::between(0, 1000),
            "keyframes before the centre of a submap");
  b.integer("keyframes_after", o.keyframes_after, Range::between(0, 1000),
            "keyframes after the centre of a submap");
  b.group("map", "planes and lines of a submap", [&](config::Binder& g) { bind(g, o.map); });
}

Submap make_submap(std::size_t centre, std::span<const PlacedKeyframe> keyframes,
                   const voxel_map::VoxelMapOptions& options) {
  parallel::Workers alone(1);
  Submap submap{centre, keyframes.front().keyframe->id, keyframes.back().keyframe->id,
                voxel_map::VoxelMap(options)};
  for (const PlacedKeyframe& placed : keyframes) {
    submap.map.insert(placed.keyframe->features, placed.T_centre_lidar, geometry::Twist::Zero(),
                      alone);
  }
  return submap;
}

}  // namespace traverse::slam
