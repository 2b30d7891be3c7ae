#include "traverse/loam/scan_to_scan.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "traverse/lidar/deskew.hpp"
#include "traverse/lidar/stopwatch.hpp"
#include "traverse/parallel/workers.hpp"

#include "point_motion.hpp"

namespace traverse::loam {

namespace {

constexpr std::size_t kPointChunk = 64;
constexpr double kLeastLine = 1e-3;  // metres between the two points of a line

/// Finds the shape of each point in the last scan; keeps the points that have one, in order.
template <typename Match, typename FindShape, typename Assign>
std::vector<Match> match_points(const lidar::TimedPoints& points,
                                const geometry::Pose3& T_last_current, const SweepClock& clock,
                                int threads, const FindShape& find_shape, const Assign& assign) {
  std::vector<std::optional<Match>> matches(points.size());
  parallel::Workers(threads).run_chunks(
      points.size(), kPointChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const double s = clock.fraction(points.time[i]);
          const Eigen::Vector3d p_lidar = points.point(i);
          const auto shape = find_shape(part_of(T_last_current, s) * p_lidar);
          if (!shape) continue;
          Match match;
          match.feature = static_cast<std::uint32_t>(i);
          match.p_lidar = p_lidar;
          match.fraction = s;
          assign(match, *shape);
          matches[i] = match;
        }
      });
  std::vector<Match> found;
  for (const auto& match : matches) {
    if (match) found.push_back(*match);
  }
  return found;
}

std::optional<Line> line_near(const Eigen::Vector3d& p_last, const LineIndex& edges,
                              const ScanToScanOptions& options) {
  const auto a = edges.nearest(p_last, options.search_radius_m);
  if (!a) return std::nullopt;
  const auto b =
      edges.nearest_across_lines(p_last, options.search_radius_m, *a, options.adjacent_lines);
  if (!b) return std::nullopt;
  const Eigen::Vector3d along = edges.point(*b) - edges.point(*a);
  if (along.norm() < kLeastLine) return std::nullopt;
  return Line{edges.point(*a), along.normalized()};
}

std::optional<Plane> plane_near(const Eigen::Vector3d& p_last, const LineIndex& planar,
                                const ScanToScanOptions& options) {
  const double radius_m = options.search_radius_m;
  const auto a = planar.nearest(p_last, radius_m);
  if (!a) return std::nullopt;
  const auto b = planar.nearest_along_line(p_last, radius_m, *a, options.min_baseline_m);
  if (!b) return std::nullopt;
  const auto c = planar.nearest_across_lines(p_last, radius_m, *a, options.adjacent_lines);
  if (!c) return std::nullopt;
  const Eigen::Vector3d ab = planar.point(*b) - planar.point(*a);
  const Eigen::Vector3d ac = planar.point(*c) - planar.point(*a);
  const Eigen::Vector3d across = ab.cross(ac);
  // Also false for three points of which two are one.
  if (!(across.norm() > options.min_triangle_sine * ab.norm() * ac.norm())) return std::nullopt;
  const Eigen::Vector3d normal = across.normalized();
  return Plane{normal, -normal.dot(planar.point(*a))};
}

}  // namespace

void bind(config::Binder& b, ScanToScanOptions& o) {
  using config::Range;
  static constexpr std::array<std::pair<std::string_view, SweepMotion>, 2> kSweepMotions{
      {{"per_point", SweepMotion::kPerPoint}, {"deskew", SweepMotion::kDeskew}}};
  b.choice("sweep_motion", o.sweep_motion, kSweepMotions,
           "per_point: the solver moves each point by its share of the unknown motion; deskew: "
           "points are moved before each association, by the motion estimated so far");
  b.integer("steps", o.steps, Range::between(1, 100), "rounds of association and solution");
  b.number("search_radius_m", o.search_radius_m, Range::positive(),
           "largest distance to a match in the previous scan");
  b.integer("adjacent_lines", o.adjacent_lines, Range::between(1, 1000),
            "scan lines up to this far away are adjacent");
  b.number("planar_voxel_m", o.planar_voxel_m, Range::positive(),
           "voxel size: one planar point per scan line and voxel of the previous scan is kept");
  b.number("min_baseline_m", o.min_baseline_m, Range::non_negative(),
           "smallest distance between the two points of one scan line that define a plane");
  b.number("min_triangle_sine", o.min_triangle_sine, Range::between(0, 1),
           "smallest sine of the angle between the sides of three points that define a plane");
  b.number("huber_m", o.huber_m, Range::positive(),
           "Huber threshold of scan-to-scan residuals, instead of solver.huber_m");
  b.number("min_eigenvalue", o.min_eigenvalue, Range::between(0, 1),
           "directions with a smaller eigenvalue are degenerate, instead of the solver's limit");
}

Matches associate_scans(const lidar::TimedPoints& sharp, const lidar::TimedPoints& flat,
                        const LineIndex& last_edges, const LineIndex& last_planar,
                        const geometry::Pose3& T_last_current, const SweepClock& clock,
                        const ScanToScanOptions& options, int threads) {
  Matches matches;
  matches.lines = match_points<LineMatch>(
      sharp, T_last_current, clock, threads,
      [&](const Eigen::Vector3d& p_last) { return line_near(p_last, last_edges, options); },
      [](LineMatch& match, const Line& line) { match.line = line; });
  matches.planes = match_points<PlaneMatch>(
      flat, T_last_current, clock, threads,
      [&](const Eigen::Vector3d& p_last) { return plane_near(p_last, last_planar, options); },
      [](PlaneMatch& match, const Plane& plane) { match.plane = plane; });
  return matches;
}

ScanToScan::ScanToScan(const ScanToScanOptions& options, const SolverOptions& solver, bool deskew,
                       int threads)
    : options_(options), solver_(solver), deskew_(deskew), threads_(threads) {
  solver_.huber_m = options.huber_m;
  solver_.min_eigenvalue = options.min_eigenvalue;
}

geometry::Twist MotionPrediction::velocity_given(const geometry::Pose3& found) const {
  if (interval_s == 0) return velocity;
  geometry::Twist twist = geometry::log_se3(found) / interval_s;
  if (turn_is_measured) twist.head<3>() = velocity.head<3>();
  return twist;
}

ScanMotion ScanToScan::follow(const SweepFeatures& sweep, const MotionPrediction& prediction,
                              lidar::StageTimes& ms) const {
  lidar::Stopwatch watch;
  const bool per_point =
      deskew_ && options_.sweep_motion == SweepMotion::kPerPoint && prediction.interval_s > 0;
  const SweepClock clock{per_point ? prediction.interval_s : 0};
  lidar::TimedPoints sharp = sweep.sharp;
  lidar::TimedPoints flat = sweep.flat;
  ScanMotion motion{prediction.T_last_current, {}};
  for (int step = 0; step < options_.steps; ++step) {
    if (deskew_ && !per_point) {
      const geometry::Twist velocity =
          step == 0 ? prediction.velocity : prediction.velocity_given(motion.T_last_current);
      sharp = lidar::deskewed(sweep.sharp, velocity);
      flat = lidar::deskewed(sweep.flat, velocity);
    }
    watch.lap(ms.deskew);
    const Matches matches = associate_scans(sharp, flat, last_edges_, last_planar_,
                                            motion.T_last_current, clock, options_, threads_);
    watch.lap(ms.associate);
    const SolveResult solved = solve_pose(matches, motion.T_last_current, solver_);
    watch.lap(ms.solve);
    ++motion.health.steps;
    motion.health.line_matches = matches.lines.size();
    motion.health.plane_matches = matches.planes.size();
    motion.health.iterations += solved.iterations;
    motion.health.observability = solved.observability;
    motion.health.residual_rms_m = solved.residual_rms_m;
    motion.health.inlier_share = solved.inlier_share;
    motion.health.registered = solved.usable;
    motion.health.end(solved.reason);
    if (!solved.usable) {
      motion.T_last_current = prediction.T_last_current;
      break;
    }
    motion.T_last_current = solved.T_map_lidar;
  }
  return motion;
}

void ScanToScan::remember(const SweepFeatures& sweep, const geometry::Twist& velocity,
                          lidar::StageTimes& ms) {
  lidar::Stopwatch watch;
  LinedPoints edges = sweep.edges;
  LinedPoints planar = sweep.planar;
  if (deskew_) {
    edges.points = lidar::deskewed(edges.points, velocity);
    planar.points = lidar::deskewed(planar.points, velocity);
  }
  watch.lap(ms.deskew);
  last_edges_ = LineIndex(std::move(edges));
  last_planar_ = LineIndex(std::move(planar));
  watch.lap(ms.index);
}

}  // namespace traverse::loam
