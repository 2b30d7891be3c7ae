#include "traverse/mapping/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <tsl/robin_map.h>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "ray_bundle.hpp"
#include "surface_cubes.hpp"

namespace traverse::mapping {

namespace {

struct Votes {
  int saw_through = 0;
  int hit = 0;
};

/// What a keyframe says of a cube.
void vote(const RayBundle& rays, const SurfaceCube& cube, const FreeSpaceOptions& options,
          Votes& votes) {
  constexpr double kLeastSine = 0.05;  // surfaces are not flatter than that
  constexpr double kUnknownSine = 0.3;
  const auto ray = rays.nearest(cube.mean, options.ray_radius_m);
  if (!ray) return;
  const double sine = cube.normal.isZero()
                          ? kUnknownSine
                          : std::max(kLeastSine, std::abs(cube.normal.dot(ray->direction)));
  const double margin = options.min_gap_m + ray->distance_m / sine;
  if (ray->beyond_m > margin) {
    ++votes.saw_through;
  } else if (ray->beyond_m > -margin) {
    ++votes.hit;
  }
}

/// The cubes by the large block that they lie in.
using Blocks = tsl::robin_map<std::uint64_t, std::vector<std::size_t>, geometry::VoxelHash>;
constexpr double kBlock_m = 8;

Blocks blocks_of(const std::vector<SurfaceCube>& cubes) {
  Blocks blocks;
  for (std::size_t c = 0; c < cubes.size(); ++c) {
    blocks[geometry::voxel_key(cubes[c].mean, kBlock_m)].push_back(c);
  }
  return blocks;
}

/// Cubes in the blocks within a range.
std::vector<std::size_t> cubes_around(const Blocks& blocks, const Eigen::Vector3d& p,
                                      double range) {
  std::vector<std::size_t> found;
  const int reach = static_cast<int>(std::ceil(range / kBlock_m));
  for (int dx = -reach; dx <= reach; ++dx) {
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dz = -reach; dz <= reach; ++dz) {
        const Eigen::Vector3d at = p + kBlock_m * Eigen::Vector3d(dx, dy, dz);
        const auto block = blocks.find(geometry::voxel_key(at, kBlock_m));
        if (block == blocks.end()) continue;
        found.insert(found.end(), block->second.begin(), block->second.end());
      }
    }
  }
  return found;
}

}  // namespace

struct FreeSpace::Content {
  SurfaceCubes surface;
  std::vector<char> is_free;  ///< one a cube
  double voxel_m = 0;
};

void bind(config::Binder& b, FreeSpaceOptions& o) {
  using config::Range;
  b.number("voxel_m", o.voxel_m, Range::between(0.02, 10), "edge of a voxel");
  b.number("max_range_m", o.max_range_m, Range::between(0.1, 1000),
           "keyframes farther away do not vote");
  b.number("ray_radius_m", o.ray_radius_m, Range::positive(),
           "distance up to which a ray passes through a voxel, or hits it");
  b.number(
      "min_gap_m", o.min_gap_m, Range::positive(),
      "distance behind the voxel from which on a ray passes through, more at grazing incidence");
  b.integer("min_votes", o.min_votes, Range::between(1, 1e6),
            "keyframes that must have seen through a voxel");
  b.number("majority", o.majority, Range::positive(),
           "ratio of keyframes that saw through to those that hit");
}

FreeSpace::FreeSpace(std::span<const MapKeyframe> keyframes, const FreeSpaceOptions& options,
                     const Progress& progress)
    : content_(std::make_unique<Content>()) {
  content_->surface = surface_cubes(keyframes, options.voxel_m);
  content_->voxel_m = options.voxel_m;
  const std::vector<SurfaceCube>& cubes = content_->surface.cubes;
  const Blocks blocks = blocks_of(cubes);
  std::vector<Votes> votes(cubes.size());
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const RayBundle rays(keyframes[k]);
    const auto near = cubes_around(blocks, rays.origin(), options.max_range_m);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, near.size()), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        const SurfaceCube& cube = cubes[near[i]];
        if ((cube.mean - rays.origin()).norm() > options.max_range_m) continue;
        vote(rays, cube, options, votes[near[i]]);
      }
    });
    if (progress) progress(static_cast<double>(k + 1) / static_cast<double>(keyframes.size()));
  }
  content_->is_free.resize(cubes.size());
  std::transform(votes.begin(), votes.end(), content_->is_free.begin(), [&](const Votes& v) {
    return v.saw_through >= options.min_votes && v.saw_through > options.majority * v.hit ? 1 : 0;
  });
}

FreeSpace::FreeSpace(FreeSpace&&) noexcept = default;
FreeSpace& FreeSpace::operator=(FreeSpace&&) noexcept = default;
FreeSpace::~FreeSpace() = default;

bool FreeSpace::is_free(const Eigen::Vector3d& p_map) const {
  const auto cube = content_->surface.at.find(geometry::voxel_key(p_map, content_->voxel_m));
  return cube != content_->surface.at.end() && content_->is_free[cube->second] != 0;
}

std::size_t FreeSpace::cubes() const { return content_->is_free.size(); }

std::size_t FreeSpace::free_cubes() const {
  return static_cast<std::size_t>(
      std::count(content_->is_free.begin(), content_->is_free.end(), char{1}));
}

std::size_t remove_free_points(const FreeSpace& free_space, std::span<MapKeyframe> keyframes) {
  std::size_t removed = 0;
  for (MapKeyframe& keyframe : keyframes) {
    std::vector<char> keep(keyframe.size());
    for (std::size_t i = 0; i < keep.size(); ++i) {
      keep[i] = free_space.is_free(keyframe.T_map_body * keyframe.p_body(i)) ? 0 : 1;
    }
    const std::size_t before = keyframe.size();
    keyframe.keep_only(keep);
    removed += before - keyframe.size();
  }
  return removed;
}

}  // namespace traverse::mapping
