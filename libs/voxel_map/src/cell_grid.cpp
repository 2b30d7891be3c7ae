#include "traverse/voxel_map/cell_grid.hpp"

#include <cmath>

namespace traverse::voxel_map {

CellGrid::CellGrid(const Eigen::Vector3d& origin_map, double edge_m)
    : cell_m(static_cast<float>(edge_m)), per_m(static_cast<float>(1 / edge_m)) {
  for (int axis = 0; axis < 3; ++axis) {
    constexpr double kFarthest = 1e9;  // of what 32 bits count, with room for what is around
    const double from_anchor = origin_map[axis] - kGridAnchor_map[axis];
    const double floor = std::floor(from_anchor / edge_m);
    const double cell = std::abs(floor) < kFarthest ? floor : 0;
    base[axis] = static_cast<std::int32_t>(cell);
    shift[axis] = static_cast<float>(from_anchor - cell * edge_m);
  }
}

Eigen::Vector3d origin_near(const Eigen::Vector3d& position_map) {
  constexpr double kStep = 64;  // metres
  return (position_map / kStep).array().round() * kStep;
}

}  // namespace traverse::voxel_map
