#pragma once

#include <span>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/geometry/pose3.hpp"
#include "traverse/slam/submap.hpp"
#include "traverse/voxel_map/alignment.hpp"

namespace traverse::slam {

struct LoopRegistrationOptions {
  voxel_map::AlignmentOptions alignment;
  double start_spacing_m = 1;  ///< between the starts of the search, in the ground plane
  double start_spacing_deg = 5;
  int max_starts = 400;        ///< about so many: a grid's rim can add as many again
  double on_surface_m = 0.15;  ///< a point so near a plane or line lies on it
};
void bind(config::Binder& binder, LoopRegistrationOptions& options);

/// Outcome of the registration of a keyframe in a submap.
struct LoopRegistration {
  geometry::Pose3 T_centre_lidar;
  lidar::RegistrationHealth health;
  double overlap = 0;       ///< share of the keyframe's points on planes and lines of the submap
  std::size_t support = 0;  ///< matches with standing planes and, twice, with lines
};

/// How far around a first guess the pose is searched.
struct SearchRegion {
  double radius_m = 0;       ///< in the ground plane of the guess
  double half_turn_rad = 0;  ///< about its z; more than half a turn is all around
};

/// Starts that cover the region: on a grid, from the inside out, the guess first. When there would
/// be too many the grid is coarser, so that however large the region is, they are at most three
/// times max_starts.
std::vector<geometry::Pose3> starts_around(const geometry::Pose3& guess, const SearchRegion& region,
                                           const LoopRegistrationOptions& options);

/// Share of the points that lie on planes and lines of the submap when the lidar stands there.
double overlap_at(const geometry::Pose3& T_centre_lidar, const Submap& submap,
                  const voxel_map::SweepSample& features, const LoopRegistrationOptions& options);

/// Registers the keyframe's features on the planes and lines of the submap as the odometry does:
/// briefly from every start, then to the end from that under which most points find their place
/// (as find_initial_velocity does; the lowest cost would favour poses with few matches).
LoopRegistration register_in(const Submap& submap, const voxel_map::SweepSample& features,
                             std::span<const geometry::Pose3> starts_centre_lidar,
                             const LoopRegistrationOptions& options);

}  // namespace traverse::slam
