#include "traverse/loam/speed_search.hpp"

#include <cmath>

#include "traverse/sensors/sweep_timing.hpp"

namespace traverse::loam {

namespace {

constexpr double kHorizontal = 0.8;  // |normal_z| above: ground or ceiling
constexpr int kRefinements = 3;      // of the first scan's deskew by the velocity found

/// Matches that speak for the motion found: those on horizontal planes would be there at any
/// speed, and where a direction is degenerate (a tunnel) no match tells one speed from another.
std::size_t speaking_matches(const Registration& registration, double inlier_m) {
  if (registration.health.observability.degenerate > 0) return 0;
  std::size_t count = 0;
  for (const LineMatch& match : registration.matches.lines) {
    const Eigen::Vector3d q = registration.T_map_lidar * match.p_lidar;
    if (line_distance_residual(match.line, q) <= inlier_m) ++count;
  }
  for (const PlaneMatch& match : registration.matches.planes) {
    if (std::abs(match.plane.normal.z()) > kHorizontal) continue;
    const Eigen::Vector3d q = registration.T_map_lidar * match.p_lidar;
    if (std::abs(plane_residual(match.plane, q)) <= inlier_m) ++count;
  }
  return count;
}

struct Hypothesis {
  geometry::Twist velocity;  // between the first two scans
  std::size_t support = 0;
};

/// Follows all scans from an empty map; each is predicted by the velocity found last.
Hypothesis follow(std::span<const ScanFeatures> scans, geometry::Twist velocity,
                  const sensors::LidarProfile& profile, const ScanToMapOptions& scan_to_map,
                  int steps) {
  lidar::StageTimes ignored;
  ScanToMap map(scan_to_map);
  map.insert(scans[0], geometry::Pose3::identity(), velocity, ignored);
  Hypothesis result{velocity, 0};
  geometry::Pose3 previous;
  for (std::size_t i = 1; i < scans.size(); ++i) {
    const double dt = sensors::scan_interval(scans[i - 1].stamp, scans[i].stamp, profile);
    const geometry::Pose3 guess = previous * geometry::exp_se3(dt * velocity);
    const Registration registration = map.align(scans[i], guess, velocity, steps, ignored);
    if (dt > 0) velocity = geometry::log_se3(previous.inverse() * registration.T_map_lidar) / dt;
    if (i == 1) result.velocity = velocity;
    result.support += speaking_matches(registration, scan_to_map.solver.huber_m);
    map.insert(scans[i], registration.T_map_lidar, velocity, ignored);
    previous = registration.T_map_lidar;
  }
  return result;
}

}  // namespace

void bind(config::Binder& b, SpeedSearchOptions& o) {
  using config::Range;
  b.integer("scans", o.scans, Range::between(0, 50),
            "scans that are held back to find the initial speed; below 2: start from rest");
  b.number("slowest_mps", o.slowest_mps, Range::between(-1000, 1000),
           "lowest hypothesis of the forward speed");
  b.number("fastest_mps", o.fastest_mps, Range::between(-1000, 1000),
           "highest hypothesis of the forward speed");
  b.number("step_mps", o.step_mps, Range::between(0.01, 1000), "step between hypotheses");
  b.integer("registration_steps", o.registration_steps, Range::between(1, 100),
            "rounds for each scan and hypothesis");
}

geometry::Twist find_initial_velocity(std::span<const ScanFeatures> first_scans,
                                      const sensors::LidarProfile& profile,
                                      const ScanToMapOptions& scan_to_map,
                                      const SpeedSearchOptions& options) {
  Hypothesis best{geometry::Twist::Zero(), 0};
  const auto hypotheses = static_cast<int>(
      std::floor((options.fastest_mps - options.slowest_mps) / options.step_mps + 1e-9));
  for (int k = 0; k <= hypotheses; ++k) {
    geometry::Twist velocity = geometry::Twist::Zero();
    velocity[3] = options.slowest_mps + k * options.step_mps;
    const Hypothesis hypothesis =
        follow(first_scans, velocity, profile, scan_to_map, options.registration_steps);
    if (hypothesis.support > best.support) best = hypothesis;
  }
  for (int k = 0; k < kRefinements; ++k) {
    best = follow(first_scans.first(2), best.velocity, profile, scan_to_map,
                  options.registration_steps);
  }
  return best.velocity;
}

}  // namespace traverse::loam
