#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace traverse::voxel_map {

/// Number of a cell relative to the base of a grid.
struct RelativeCell {
  std::int32_t x, y, z;
  bool operator==(const RelativeCell&) const = default;
};

/// Where the grids of all cells begin, metres in the map frame. Not its origin: people build, and
/// simulate, at round distances from where they start, and a wall along the faces of its cells is
/// cut into halves whose planes lie beside it.
inline const Eigen::Vector3d kGridAnchor_map{0.157, 0.211, 0.173};

/// How floats near the vehicle and the cells of a map meet. Cells are anchored to the map frame and
/// numbered from kGridAnchor_map; points come as floats relative to a nearby `origin_map`, so that
/// a float is fine enough however far the drive goes.
struct CellGrid {
  float cell_m;
  float per_m;           ///< 1 / cell_m
  float shift[3];        ///< origin_map minus the lower corner of its cell, metres
  std::int32_t base[3];  ///< the cell of origin_map

  CellGrid(const Eigen::Vector3d& origin_map, double edge_m);

  /// Number of the cell that holds coordinate `value` along `axis`; relative to base.
  std::int32_t cell(float value, int axis) const {
    const float edges = (value + shift[axis]) * per_m;
    const auto whole = static_cast<std::int32_t>(edges);
    return whole - static_cast<std::int32_t>(edges < static_cast<float>(whole));
  }
  RelativeCell cell(float x, float y, float z) const {
    return {cell(x, 0), cell(y, 1), cell(z, 2)};
  }
  /// Coordinate of the centre of a cell relative to base.
  float centre(std::int32_t relative_cell, int axis) const {
    return (static_cast<float>(relative_cell) + 0.5F) * cell_m - shift[axis];
  }
};

/// Centre of a cell of edge `cell_m`, map frame.
inline Eigen::Vector3d cell_centre(std::int32_t x, std::int32_t y, std::int32_t z, double cell_m) {
  return kGridAnchor_map + cell_m * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5);
}

/// An origin near `position_map` for the floats of a frame; the same for neighbouring positions.
Eigen::Vector3d origin_near(const Eigen::Vector3d& position_map);

}  // namespace traverse::voxel_map
