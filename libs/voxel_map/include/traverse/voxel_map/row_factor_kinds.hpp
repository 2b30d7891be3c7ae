#pragma once

#include <vector>

#include "traverse/optimization/factor_kind.hpp"

namespace traverse::voxel_map {

/// The rows of the voxel-map odometry for the check of their Jacobians: that of a plane and the two
/// of a line, of points that are deskewed by the motion that ends in the pose. The exact ones:
/// evaluate() keeps the first order of the motion within the sweep (docs/mathematics.md).
std::vector<optimization::FactorKind> row_factor_kinds();

/// Both, as the odometry uses them. Without deskew all shares s are zero.
std::vector<optimization::FactorUse> row_factors();

}  // namespace traverse::voxel_map
