#pragma once

#include "traverse/lidar/frame.hpp"
#include "traverse/lidar/observability.hpp"
#include "traverse/parallel/workers.hpp"
#include "traverse/voxel_map/local_points.hpp"
#include "traverse/voxel_map/scan_matches.hpp"
#include "traverse/voxel_map/scan_objective.hpp"
#include "traverse/voxel_map/voxel_map.hpp"

/// The two steps of a registration that do not depend on how it is solved: what a scan matches at
/// a pose, and which directions of motion these matches determine.
namespace traverse::voxel_map {

/// A scan's points in the map; kept from round to round for its memory.
struct MovedSample {
  LocalPoints planar;
  LocalPoints edges;
};

/// Matches the scan at a pose (associate()). \param moved, matches  written  \param ms  added to
void associate_at(const SweepSample& sample, const geometry::Pose3& T_map_lidar,
                  const MotionModel& motion, const VoxelMap& map, double gate_m,
                  const MatchOptions& options, parallel::Workers& workers, MovedSample& moved,
                  ScanMatches& matches, lidar::StageTimes& ms);

/// The median range of the points that are registered, metres; 1 where there are none.
double usual_range_m(const SweepSample& sample);

/// Which directions the matches determine. One is degenerate where the information on it is no more
/// than what noise of the map's normals explains (facing_information.hpp).
/// \param normal  of the matches at the pose  \param scale_m  usual_range_m()
lidar::Observability judged_observability(const NormalEquations& normal, const ScanMatches& matches,
                                          const geometry::Pose3& T_map_lidar,
                                          const MotionModel& motion, double scale_m,
                                          double min_eigenvalue);

/// Of the information on each direction the share that is of surfaces that face it: the rest is as
/// noise of normals makes it. 1 where that cannot matter, 0 where the direction is degenerate.
/// \param seen  judged_observability() of the same
lidar::Vector6 facing_shares(const lidar::Observability& seen, const ScanMatches& matches,
                             const geometry::Pose3& T_map_lidar, const MotionModel& motion);

}  // namespace traverse::voxel_map
