#pragma once

#include <vector>

#include "traverse/lidar/odometry.hpp"
#include "traverse/voxel_map/scan_matches.hpp"

namespace traverse::voxel_map {

/// The matches of a scan as points under its pose with their feet on planes and lines, for the eye.
/// \param velocity body twist a second that deskews the scan; zero if it is not deskewed
std::vector<lidar::MatchedPoint> matched_points(const ScanMatches& matches,
                                                const geometry::Pose3& T_map_lidar,
                                                const geometry::Twist& velocity);

}  // namespace traverse::voxel_map
