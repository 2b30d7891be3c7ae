#pragma once

#include <span>

#include "traverse/config/binder.hpp"
#include "traverse/parallel/workers.hpp"
#include "traverse/voxel_map/alignment.hpp"

namespace traverse::voxel_map {

/// A recording may begin at full speed, and an odometry that starts from rest never makes the loss
/// good. So the first scans are held back and followed under several hypotheses of the speed.
struct StartSearchOptions {
  int scans = 4;            ///< held back and followed; below 2: no search, start from rest
  double slowest_mps = -8;  ///< hypotheses: from here
  double fastest_mps = 44;  ///< to here
  double step_mps = 4;      ///< in these steps
};
void bind(config::Binder& binder, StartSearchOptions& options);

/// The body twist a second at the first scan under which most points of the following ones find
/// their place in a map built from the scans before: matches with planes that are not horizontal
/// (the ground supports every speed) and, twice, with lines. The number of matches, not the cost of
/// the fit: the lowest cost picks wrong, lower speeds. Zero when the scans do not tell (a tunnel).
/// \param first_scans at least two, in order of time  \param intervals_s [i] from scan i to i + 1
geometry::Twist find_initial_velocity(std::span<const SweepSample> first_scans,
                                      std::span<const double> intervals_s, bool deskew,
                                      const VoxelMapOptions& map, const AlignmentOptions& alignment,
                                      const StartSearchOptions& options,
                                      parallel::Workers& workers);

}  // namespace traverse::voxel_map
