#pragma once

#include "traverse/geometry/pose3.hpp"
#include "traverse/lidar/observability.hpp"
#include "traverse/voxel_map/scan_matches.hpp"
#include "traverse/voxel_map/scan_objective.hpp"

namespace traverse::voxel_map {

/// What the matches whose surfaces face a direction of motion tell of it: the sum of
/// weight * (J along)^2 over the rows with |J along| >= 1/4, over the sum of all weights. J is the
/// derivative of a row's distance by the pose; a line is two rows of one match. In a featureless
/// corridor normals that are off by a few hundredths add up to information along it that is only
/// noise; none of them faces it.
/// \param along body twist of the lidar [rotation in radians per metre of motion, translation]
/// \returns as eigenvalues of the matches' mean information: 1 if every surface faces the direction
double facing_information(const ScanMatches& matches, const geometry::Pose3& T_map_lidar,
                          const MotionModel& motion, const lidar::Vector6& along);

}  // namespace traverse::voxel_map
