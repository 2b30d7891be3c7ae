#pragma once

#include "traverse/config/binder.hpp"
#include "traverse/lidar/frame.hpp"
#include "traverse/parallel/workers.hpp"
#include "traverse/voxel_map/scan_objective.hpp"
#include "traverse/voxel_map/voxel_map.hpp"

namespace traverse::voxel_map {

struct AlignmentOptions {
  int rounds = 6;              ///< of association and solve at most
  int iterations = 1;          ///< of Levenberg-Marquardt in a round
  double gate_m = 0.6;         ///< farther planes and lines do not match, in the first two rounds;
  double narrow_gate_m = 0.3;  ///< then half of it each round, down to this
  double converged_m = 0.002;  ///< a round that moves the pose by less than both is the last
  double converged_deg = 0.006;
  int min_matches = 50;           ///< with fewer the prediction stands
  double min_eigenvalue = 0.001;  ///< less from surfaces that face it: a direction is degenerate
  MatchOptions matches;
  ObjectiveOptions objective;
};
void bind(config::Binder& binder, AlignmentOptions& options);

/// Outcome of the registration of one scan.
struct Alignment {
  geometry::Pose3 T_map_lidar;
  /// With the reason why it ended (converged: the last round moved the pose by less than
  /// converged_m and converged_deg) and, when asked, the covariance of the pose.
  lidar::RegistrationHealth health;
  std::size_t standing_planes = 0;  ///< matches with planes that are not nearly horizontal
};

/// How hard to try: the first frames come with worse predictions.
struct Effort {
  int extra_rounds = 0;
  double gate_factor = 1;
};

/// Moves the pose so that the scan's points come onto the planes and lines of the map. Each round
/// associates at the present pose, then Ceres minimises the robust cost of these matches (one
/// condensed cost function, whose derivative is analytic). Which directions the matches determine
/// is judged at the pose that the rounds lead to, not on the way: matches at a wrong guess say
/// little of what can be seen. A direction is degenerate where the information on it is no more
/// than what noise of the map's normals explains (facing_information.hpp); it keeps its prediction,
/// and the others are solved once more with it.
/// \param matches of the last round, on return; what it held before does not matter
Alignment align(const SweepSample& sample, const VoxelMap& map, const MotionModel& motion,
                const geometry::Pose3& guess_T_map_lidar, const AlignmentOptions& options,
                const Effort& effort, parallel::Workers& workers, ScanMatches& matches,
                lidar::StageTimes& ms);

}  // namespace traverse::voxel_map
