#pragma once

#include "traverse/geometry/pose3.hpp"
#include "traverse/lidar/observability.hpp"
#include "traverse/loam/association.hpp"

namespace traverse::loam {

/// How well `matches` determine each direction of motion at the pose `T_map_lidar`.
/// \param min_eigenvalue directions with a smaller eigenvalue are degenerate
lidar::Observability observability(const Matches& matches, const geometry::Pose3& T_map_lidar,
                                   double min_eigenvalue);

}  // namespace traverse::loam
