#include "traverse/loam/two_stage_odometry.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "traverse/lidar/deskew.hpp"
#include "traverse/lidar/stopwatch.hpp"
#include "traverse/loam/factor_kinds.hpp"
#include "traverse/sensors/sweep_timing.hpp"

#include "classified_scan.hpp"
#include "matched_points.hpp"

namespace traverse::loam {

namespace {

constexpr double kLeastInterval = 0.1;  // sweeps; stamps nearer than that tell no speed

ScanToMapOptions scan_to_map_options(const TwoStageOdometryOptions& options, bool deskew) {
  return {options.map, options.association, options.solver, deskew, options.threads};
}

/// What the first stage tells of a frame beyond what all odometry does.
struct FirstStage {
  lidar::RegistrationHealth health;
  bool turn_is_measured = false;
};

/// In the order of further_columns().
std::vector<double> record_of(const FirstStage& stage) {
  const lidar::RegistrationHealth& health = stage.health;
  return {health.registered ? 1.0 : 0.0,
          static_cast<double>(health.line_matches),
          static_cast<double>(health.plane_matches),
          health.residual_rms_m,
          health.inlier_share,
          static_cast<double>(health.iterations),
          static_cast<double>(health.observability.degenerate),
          health.observability.eigenvalues[0],
          stage.turn_is_measured ? 1.0 : 0.0};
}

}  // namespace

void bind(config::Binder& b, TwoStageOdometryOptions& o) {
  using config::Range;
  b.flag("deskew", o.deskew, "undo the motion within a sweep, unless the recording did");
  b.group("features", "curvature and classes of points",
          [&](config::Binder& g) { bind(g, o.features); });
  b.group("odometry", "from scan to scan, the first stage",
          [&](config::Binder& g) { bind(g, o.odometry); });
  b.group("thinning", "points that the second stage registers",
          [&](config::Binder& g) { bind(g, o.thinning); });
  b.group("map", "the local map of the second stage", [&](config::Binder& g) { bind(g, o.map); });
  b.group("association", "association of features with lines and planes of the map",
          [&](config::Binder& g) { bind(g, o.association); });
  b.group("solver", "solver of the pose, in both stages",
          [&](config::Binder& g) { bind(g, o.solver); });
  b.integer("registration_steps", o.registration_steps, Range::between(0, 100),
            "rounds of association and solution in the map; 0: scan-to-scan odometry alone");
  b.group("imu", "prediction of rotations", [&](config::Binder& g) { bind(g, o.imu); });
  b.group("start", "search for the initial speed", [&](config::Binder& g) { bind(g, o.start); });
}

TwoStageOdometry::TwoStageOdometry(const TwoStageOdometryOptions& options,
                                   const sensors::LidarProfile& profile, bool motion_compensated)
    : options_(options),
      profile_(profile),
      deskew_note_(lidar::deskew_note(options.deskew, profile, motion_compensated)),
      scan_to_map_(scan_to_map_options(options, deskew_note_ == "on")),
      scan_to_scan_(options.odometry, options.solver, deskew_note_ == "on", options.threads),
      map_(scan_to_map_),
      imu_(options.imu),
      held_back_(options.start.scans) {}

std::vector<lidar::Frame> TwoStageOdometry::process(const sensors::LidarScan& scan) {
  Prepared prepared;
  lidar::Stopwatch watch;
  const lidar::ScanLines lines = lidar::organise(scan, profile_);
  watch.lap(prepared.ms.organise);
  const Features features = extract_features(lines, options_.features);
  prepared.features = collect_features(scan, profile_, lines, features, options_.thinning);
  prepared.sweep = collect_sweep(scan, profile_, lines, features, options_.odometry.planar_voxel_m);
  watch.lap(prepared.ms.features);

  return advance_all(held_back_.add(std::move(prepared)));
}

std::vector<lidar::Frame> TwoStageOdometry::finish() { return advance_all(held_back_.release()); }

void TwoStageOdometry::observe(const sensors::ImuSample& sample_lidar) {
  imu_.observe(sample_lidar);
}

lidar::CorrectedScan TwoStageOdometry::used_scan(const sensors::LidarScan& scan,
                                                 const geometry::Twist& velocity,
                                                 bool with_classes) const {
  const geometry::Twist motion = deskew_note_ == "on" ? velocity : geometry::Twist::Zero();
  return with_classes ? corrected_and_classified(scan, profile_, motion, options_.features)
                      : lidar::corrected(scan, profile_, motion);
}

const std::vector<std::string>& TwoStageOdometry::further_columns() const {
  static const std::vector<std::string> kColumns{"odometry_registered",
                                                 "odometry_line_matches",
                                                 "odometry_plane_matches",
                                                 "odometry_residual_rms_m",
                                                 "odometry_inlier_share",
                                                 "odometry_solver_iterations",
                                                 "odometry_degenerate_directions",
                                                 "odometry_eigenvalue_1",
                                                 "odometry_turn_measured"};
  return kColumns;
}

std::vector<optimization::FactorUse> TwoStageOdometry::factors() const {
  const bool swept =
      deskew_note_ == "on" && options_.odometry.sweep_motion == SweepMotion::kPerPoint;
  std::vector<optimization::FactorUse> uses =
      factors_of(options_.solver, swept ? Sweep::kSwept : Sweep::kDeskewed);
  if (swept && options_.registration_steps > 0) {
    for (optimization::FactorUse& use : factors_of(options_.solver)) uses.push_back(std::move(use));
  }
  return uses;
}

std::vector<Eigen::Vector3d> TwoStageOdometry::local_map() const {
  return options_.registration_steps > 0 ? map_.points() : std::vector<Eigen::Vector3d>{};
}

std::vector<lidar::MatchedPoint> TwoStageOdometry::matches() const {
  return matched_points(matches_, T_map_last_);
}

std::vector<lidar::Frame> TwoStageOdometry::advance_all(std::vector<Prepared> scans) {
  if (frames_ == 0 && !scans.empty()) velocity_ = initial_velocity(scans);
  std::vector<lidar::Frame> frames;
  for (const Prepared& scan : scans) frames.push_back(advance(scan));
  return frames;
}

geometry::Twist TwoStageOdometry::initial_velocity(std::vector<Prepared>& first) const {
  lidar::Stopwatch watch;
  std::vector<ScanFeatures> scans;
  for (const Prepared& scan : first) {
    const bool later = scans.empty() || scan.features.stamp > scans.back().stamp;
    if (later) scans.push_back(scan.features);
  }
  geometry::Twist velocity = geometry::Twist::Zero();
  if (scans.size() >= 2) {
    velocity = find_initial_velocity(scans, profile_, scan_to_map_, options_.start);
  }
  watch.lap(first.front().ms.start);
  return velocity;
}

MotionPrediction TwoStageOdometry::predict(geometry::Stamp stamp) const {
  MotionPrediction prediction;
  const double interval_s = sensors::scan_interval(last_stamp_, stamp, profile_);
  if (interval_s >= kLeastInterval * profile_.sweep_s) prediction.interval_s = interval_s;
  geometry::Twist step = prediction.interval_s * velocity_;
  prediction.velocity = velocity_;
  if (const auto turn = imu_.rotation(last_stamp_, stamp)) step.head<3>() = *turn;
  const geometry::Stamp sweep_begin =
      geometry::shifted(stamp, -profile_.stamp_fraction * profile_.sweep_s);
  const geometry::Stamp sweep_end = geometry::shifted(sweep_begin, profile_.sweep_s);
  if (const auto turn = imu_.rotation(sweep_begin, sweep_end)) {
    prediction.velocity.head<3>() = *turn / profile_.sweep_s;
    prediction.turn_is_measured = true;
  }
  prediction.T_last_current = geometry::exp_se3(step);
  return prediction;
}

lidar::Frame TwoStageOdometry::advance(const Prepared& scan) {
  lidar::Frame frame;
  frame.index = frames_;
  frame.stamp = scan.features.stamp;
  frame.points = scan.features.points;
  frame.dropped = scan.features.dropped;
  frame.class_counts = scan.features.class_counts;
  frame.ms = scan.ms;
  frame.velocity = velocity_;
  FirstStage odometry;

  if (frames_ > 0) {
    const MotionPrediction prediction = predict(frame.stamp);
    const ScanMotion motion = scan_to_scan_.follow(scan.sweep, prediction, frame.ms);
    odometry = {motion.health, prediction.turn_is_measured};
    T_odom_lidar_ = (T_odom_lidar_ * motion.T_last_current).orthonormalised();
    frame.velocity = odometry.health.registered ? prediction.velocity_given(motion.T_last_current)
                                                : prediction.velocity;

    Registration refined = map_.align(scan.features, T_map_odom_ * T_odom_lidar_, frame.velocity,
                                      options_.registration_steps, frame.ms);
    frame.T_map_lidar = refined.T_map_lidar.orthonormalised();
    frame.health = refined.health;
    matches_ = std::move(refined.matches);
    const geometry::Pose3 T_last_current = T_map_last_.inverse() * frame.T_map_lidar;
    if (refined.health.registered) {
      T_map_odom_ = frame.T_map_lidar * T_odom_lidar_.inverse();
      frame.velocity = prediction.velocity_given(T_last_current);
    }
    const bool moved = refined.health.registered || odometry.health.registered;
    if (moved && prediction.interval_s > 0) {
      velocity_ = geometry::log_se3(T_last_current) / prediction.interval_s;
    }
  }
  // A pose that is only predicted does not shape the map, unless there is no map yet.
  const bool map_is_empty = map_.size() < static_cast<std::size_t>(options_.solver.min_matches);
  if (frame.health.registered || odometry.health.registered || map_is_empty) {
    map_.insert(scan.features, frame.T_map_lidar, frame.velocity, frame.ms);
  }
  scan_to_scan_.remember(scan.sweep, frame.velocity, frame.ms);
  frame.map_points = map_.size();
  frame.further = record_of(odometry);

  T_map_last_ = frame.T_map_lidar;
  last_stamp_ = frame.stamp;
  imu_.forget_before(geometry::shifted(last_stamp_, -profile_.sweep_s));
  ++frames_;
  return frame;
}

}  // namespace traverse::loam
