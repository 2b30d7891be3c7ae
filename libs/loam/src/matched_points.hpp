#pragma once

#include <vector>

#include "traverse/lidar/odometry.hpp"
#include "traverse/loam/association.hpp"

namespace traverse::loam {

/// The matches of a deskewed scan as points under its pose with their feet on lines and planes.
std::vector<lidar::MatchedPoint> matched_points(const Matches& matches,
                                                const geometry::Pose3& T_map_lidar);

}  // namespace traverse::loam
