#include "traverse/voxel_map/cell_grid.hpp"

#include <cmath>

namespace traverse::voxel_map {

CellGrid::CellGrid(const Eigen::Vector3d& origin_map, double edge_m)
    : cell_m(static_cast<float>(edge_m)), per_m(static_cast<float>(1 / edge_m)) {
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = std::floor(origin_map[axis] / edge_m);
    base[axis] = static_cast<std::int32_t>(cell);
    shift[axis] = static_cast<float>(origin_map[axis] - cell * edge_m);
  }
}

Eigen::Vector3d origin_near(const Eigen::Vector3d& position_map) {
  constexpr double kStep = 64;  // metres
  return (position_map / kStep).array().round() * kStep;
}

}  // namespace traverse::voxel_map
