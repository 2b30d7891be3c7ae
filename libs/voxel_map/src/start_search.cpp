#include "traverse/voxel_map/start_search.hpp"

#include <cmath>

#include "traverse/parallel/workers.hpp"

namespace traverse::voxel_map {

namespace {

constexpr int kRefinements = 3;  // of the first scan's deskew by the velocity found
constexpr Effort kMuchEffort{2, 1.7};

struct Hypothesis {
  geometry::Twist velocity = geometry::Twist::Zero();  // between the first two scans
  std::size_t support = 0;
};

/// Follows all scans from an empty map; each is predicted by the velocity found last.
class Follower {
 public:
  Follower(std::span<const SweepSample> scans, std::span<const double> intervals_s, bool deskew,
           const VoxelMapOptions& map, const AlignmentOptions& alignment)
      : scans_(scans),
        intervals_s_(intervals_s),
        deskew_(deskew),
        map_options_(map),
        alignment_(alignment) {
    map_options_.lines.min_frames = 1;  // there are not three frames yet
  }

  Hypothesis follow(const geometry::Twist& start, std::size_t scans,
                    parallel::Workers& workers) const {
    lidar::StageTimes ignored;
    Hypothesis result{start, 0};
    geometry::Twist velocity = start;
    ScanMatches matches;
    VoxelMap map(map_options_);
    map.insert(scans_[0], geometry::Pose3::identity(), deskew_twist(velocity), workers);
    geometry::Pose3 previous;
    for (std::size_t i = 1; i < scans; ++i) {
      const double dt = intervals_s_[i - 1];
      const geometry::Pose3 guess = previous * geometry::exp_se3(dt * velocity);
      const Alignment found = align(scans_[i], map, {previous, dt, deskew_}, guess, alignment_,
                                    kMuchEffort, workers, matches, ignored);
      velocity = geometry::log_se3(previous.inverse() * found.T_map_lidar) / dt;
      if (i == 1) result.velocity = velocity;
      result.support += support_of(found);
      map.insert(scans_[i], found.T_map_lidar, deskew_twist(velocity), workers);
      previous = found.T_map_lidar;
    }
    return result;
  }

 private:
  geometry::Twist deskew_twist(const geometry::Twist& velocity) const {
    return deskew_ ? velocity : geometry::Twist::Zero();
  }

  /// Where a direction is degenerate (a tunnel) no match tells one speed from another.
  static std::size_t support_of(const Alignment& found) {
    if (!found.health.registered || found.health.observability.degenerate > 0) return 0;
    return found.standing_planes + 2 * found.health.line_matches;
  }

  std::span<const SweepSample> scans_;
  std::span<const double> intervals_s_;
  bool deskew_;
  VoxelMapOptions map_options_;
  const AlignmentOptions& alignment_;
};

}  // namespace

void bind(config::Binder& b, StartSearchOptions& o) {
  using config::Range;
  b.integer("scans", o.scans, Range::between(0, 50),
            "scans that are held back to find the initial speed; below 2: start from rest");
  b.number("slowest_mps", o.slowest_mps, Range::between(-1000, 1000),
           "lowest hypothesis of the forward speed");
  b.number("fastest_mps", o.fastest_mps, Range::between(-1000, 1000),
           "highest hypothesis of the forward speed");
  b.number("step_mps", o.step_mps, Range::between(0.01, 1000), "step between hypotheses");
}

geometry::Twist find_initial_velocity(std::span<const SweepSample> first_scans,
                                      std::span<const double> intervals_s, bool deskew,
                                      const VoxelMapOptions& map, const AlignmentOptions& alignment,
                                      const StartSearchOptions& options,
                                      parallel::Workers& workers) {
  const Follower follower(first_scans, intervals_s, deskew, map, alignment);
  const auto steps = static_cast<std::size_t>(std::max(
      0.0, std::floor((options.fastest_mps - options.slowest_mps) / options.step_mps + 1e-9)));
  std::vector<Hypothesis> hypotheses(steps + 1);
  workers.run(hypotheses.size(), [&](std::size_t k) {
    parallel::Workers alone(1);
    geometry::Twist velocity = geometry::Twist::Zero();
    velocity[3] = options.slowest_mps + static_cast<double>(k) * options.step_mps;
    // Twice: the first scan was deskewed by the hypothesis, then by what it led to.
    const Hypothesis once = follower.follow(velocity, 2, alone);
    hypotheses[k] = follower.follow(once.velocity, first_scans.size(), alone);
  });
  Hypothesis best;
  for (const Hypothesis& hypothesis : hypotheses) {
    if (hypothesis.support > best.support) best = hypothesis;
  }
  if (best.support == 0) return geometry::Twist::Zero();
  for (int k = 0; k < kRefinements; ++k) best = follower.follow(best.velocity, 2, workers);
  return best.velocity;
}

}  // namespace traverse::voxel_map
