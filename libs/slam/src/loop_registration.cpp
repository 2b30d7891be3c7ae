#include "traverse/slam/loop_registration.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/parallel/workers.hpp"

namespace traverse::slam {

namespace {

using voxel_map::Alignment;
using voxel_map::AlignmentOptions;
using voxel_map::Effort;

constexpr Effort kMuchEffort{6, 2};
constexpr double kCoarser = 1.2;                       // where there would be too many starts
const voxel_map::MotionModel kStanding{{}, 1, false};  // keyframes are deskewed

/// Grid points to one side of the middle one, so that no place is farther than half a spacing off.
double steps_to(double reach, double spacing) {
  return std::max(0.0, std::ceil(reach / spacing - 0.5));
}

std::size_t support_of(const Alignment& found) {
  return found.health.registered ? found.standing_planes + 2 * found.health.line_matches : 0;
}

/// Two rounds with a wide gate: enough to tell a start that falls into place.
AlignmentOptions brief(AlignmentOptions options) {
  options.rounds = 2;
  return options;
}

/// One more round with a gate so narrow that only points on their surfaces match.
AlignmentOptions only_on_surfaces(AlignmentOptions options, double gate_m) {
  options.rounds = 1;
  options.gate_m = gate_m;
  options.narrow_gate_m = gate_m;
  return options;
}

}  // namespace

void bind(config::Binder& b, LoopRegistrationOptions& o) {
  using config::Range;
  b.group("alignment", "registration of a keyframe in a submap",
          [&](config::Binder& g) { bind(g, o.alignment); });
  b.number("start_spacing_m", o.start_spacing_m, Range::positive(),
           "distance between the starts of the search");
  b.number("start_spacing_deg", o.start_spacing_deg, Range::positive(),
           "angle between their headings");
  b.integer("max_starts", o.max_starts, Range::between(1, 1e6),
            "starts of one registration at most");
  b.number("on_surface_m", o.on_surface_m, Range::positive(),
           "distance from a plane or line up to which a point lies on it");
}

std::vector<geometry::Pose3> starts_around(const geometry::Pose3& guess, const SearchRegion& region,
                                           const LoopRegistrationOptions& options) {
  // Counted in doubles: a region can be larger than an int of its grid's cells.
  const double half_turn_rad = std::min(region.half_turn_rad, std::numbers::pi);
  double spacing_rad = options.start_spacing_deg * geometry::kDegree;
  double spacing_m = options.start_spacing_m;
  const auto headings = [&] { return 2 * steps_to(half_turn_rad, spacing_rad) + 1; };
  const auto positions = [&] {
    const double side = steps_to(region.radius_m, spacing_m);
    return 3 * side * side;
  };
  while (headings() > options.max_starts) spacing_rad *= kCoarser;
  while (positions() * headings() > options.max_starts) spacing_m *= kCoarser;

  struct Start {
    double distance;
    geometry::Pose3 pose;
  };
  std::vector<Start> starts;
  const int turns = static_cast<int>(steps_to(half_turn_rad, spacing_rad));
  const int side = static_cast<int>(steps_to(region.radius_m, spacing_m));
  for (int ix = -side; ix <= side; ++ix) {
    for (int iy = -side; iy <= side; ++iy) {
      const Eigen::Vector3d shift(ix * spacing_m, iy * spacing_m, 0);
      if (shift.norm() > region.radius_m + 0.5 * spacing_m) continue;
      for (int turn = -turns; turn <= turns; ++turn) {
        geometry::Pose3 offset;
        const double angle = turn * spacing_rad;
        offset.rotation = geometry::exp_so3(Eigen::Vector3d(0, 0, angle));
        offset.translation = shift;
        starts.push_back({shift.norm() + std::abs(turn) * 1e-3, guess * offset});
      }
    }
  }
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.distance < b.distance; });
  std::vector<geometry::Pose3> poses;
  poses.reserve(starts.size());
  for (const Start& start : starts) poses.push_back(start.pose);
  return poses;
}

double overlap_at(const geometry::Pose3& T_centre_lidar, const Submap& submap,
                  const voxel_map::SweepSample& features, const LoopRegistrationOptions& options) {
  const std::size_t points = features.planar.size() + features.edges.size();
  if (points == 0) return 0;
  parallel::Workers alone(1);
  lidar::StageTimes ignored;
  voxel_map::ScanMatches matches;
  const Alignment found = align(features, submap.map, kStanding, T_centre_lidar,
                                only_on_surfaces(options.alignment, options.on_surface_m), Effort{},
                                alone, matches, ignored);
  const std::size_t on_surfaces = found.health.plane_matches + found.health.line_matches;
  return static_cast<double>(on_surfaces) / static_cast<double>(points);
}

LoopRegistration register_in(const Submap& submap, const voxel_map::SweepSample& features,
                             std::span<const geometry::Pose3> starts_centre_lidar,
                             const LoopRegistrationOptions& options) {
  parallel::Workers alone(1);
  lidar::StageTimes ignored;
  voxel_map::ScanMatches matches;
  const auto align_from = [&](const geometry::Pose3& start, const AlignmentOptions& how,
                              const Effort& effort) {
    return align(features, submap.map, kStanding, start, how, effort, alone, matches, ignored);
  };

  geometry::Pose3 best = starts_centre_lidar.front();
  if (starts_centre_lidar.size() > 1) {
    std::size_t most = 0;
    for (const geometry::Pose3& start : starts_centre_lidar) {
      const Alignment tried = align_from(start, brief(options.alignment), {0, 2});
      const std::size_t support = support_of(tried);
      if (support <= most) continue;
      most = support;
      best = tried.T_map_lidar;
    }
  }
  const Alignment found = align_from(best, options.alignment, kMuchEffort);
  LoopRegistration result;
  result.T_centre_lidar = found.T_map_lidar.orthonormalised();
  result.health = found.health;
  result.support = support_of(found);
  if (!found.health.registered) return result;

  result.overlap = overlap_at(found.T_map_lidar, submap, features, options);
  return result;
}

}  // namespace traverse::slam
