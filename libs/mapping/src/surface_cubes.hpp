#pragma once

#include <cstdint>
#include <span>
#include <tsl/robin_map.h>
#include <vector>

#include <Eigen/Core>

#include "traverse/geometry/voxel.hpp"
#include "traverse/mapping/map_keyframe.hpp"

namespace traverse::mapping {

/// The points of a cube of the map, and the surface that they are on.
struct SurfaceCube {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();    ///< map frame
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit; zero where there is no plane
  int points = 0;
};

struct SurfaceCubes {
  std::vector<SurfaceCube> cubes;  ///< in the order in which they were met
  tsl::robin_map<std::uint64_t, std::size_t, geometry::VoxelHash> at;  ///< by voxel_key
};

/// \param voxel_m edge of a cube; planes are fitted in cubes four times as large
SurfaceCubes surface_cubes(std::span<const MapKeyframe> keyframes, double voxel_m);

}  // namespace traverse::mapping
