#include "traverse/loam/scan_to_map_odometry.hpp"

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

ScanToMapOptions scan_to_map_options(const ScanToMapOdometryOptions& options, bool deskew) {
  return {options.map, options.association, options.solver, deskew, options.threads};
}

}  // namespace

void bind(config::Binder& b, ScanToMapOdometryOptions& o) {
  using config::Range;
  b.flag("deskew", o.deskew, "undo the motion within a sweep, unless the recording did");
  b.group("features", "curvature and classes of points",
          [&](config::Binder& g) { bind(g, o.features); });
  b.group("thinning", "points that are registered",
          [&](config::Binder& g) { bind(g, o.thinning); });
  b.group("map", "the local map", [&](config::Binder& g) { bind(g, o.map); });
  b.group("association", "association of features with lines and planes of the map",
          [&](config::Binder& g) { bind(g, o.association); });
  b.group("solver", "solver of the pose", [&](config::Binder& g) { bind(g, o.solver); });
  b.integer("registration_steps", o.registration_steps, Range::between(1, 100),
            "rounds of association and solution per frame");
  b.integer("first_registration_steps", o.first_registration_steps, Range::between(1, 100),
            "rounds for the second frame; one fewer for each further frame");
  b.group("start", "search for the initial speed", [&](config::Binder& g) { bind(g, o.start); });
}

ScanToMapOdometry::ScanToMapOdometry(const ScanToMapOdometryOptions& options,
                                     const sensors::LidarProfile& profile, bool motion_compensated)
    : options_(options),
      profile_(profile),
      deskew_note_(lidar::deskew_note(options.deskew, profile, motion_compensated)),
      scan_to_map_(scan_to_map_options(options, deskew_note_ == "on")),
      map_(scan_to_map_),
      held_back_(options.start.scans) {}

std::vector<lidar::Frame> ScanToMapOdometry::process(const sensors::LidarScan& scan) {
  Prepared prepared;
  lidar::Stopwatch watch;
  const lidar::ScanLines lines = lidar::organise(scan, profile_);
  watch.lap(prepared.ms.organise);
  const Features features = extract_features(lines, options_.features);
  prepared.features = collect_features(scan, profile_, lines, features, options_.thinning);
  watch.lap(prepared.ms.features);

  return advance_all(held_back_.add(std::move(prepared)));
}

std::vector<lidar::Frame> ScanToMapOdometry::finish() { return advance_all(held_back_.release()); }

std::vector<optimization::FactorUse> ScanToMapOdometry::factors() const {
  return factors_of(options_.solver);
}

lidar::CorrectedScan ScanToMapOdometry::used_scan(const sensors::LidarScan& scan,
                                                  const geometry::Twist& velocity,
                                                  bool with_classes) const {
  const geometry::Twist motion = deskew_note_ == "on" ? velocity : geometry::Twist::Zero();
  return with_classes ? corrected_and_classified(scan, profile_, motion, options_.features)
                      : lidar::corrected(scan, profile_, motion);
}

std::vector<lidar::MatchedPoint> ScanToMapOdometry::matches() const {
  return matched_points(matches_, T_map_last_);
}

std::vector<lidar::Frame> ScanToMapOdometry::advance_all(std::vector<Prepared> scans) {
  if (frames_ == 0 && scans.size() >= 2) {
    lidar::Stopwatch watch;
    std::vector<ScanFeatures> first;
    for (const Prepared& scan : scans) first.push_back(scan.features);
    velocity_ = find_initial_velocity(first, profile_, scan_to_map_, options_.start);
    watch.lap(scans.front().ms.start);
  }
  std::vector<lidar::Frame> frames;
  for (const Prepared& scan : scans) frames.push_back(advance(scan));
  return frames;
}

int ScanToMapOdometry::steps_of_this_frame() const {
  return std::max(options_.registration_steps,
                  options_.first_registration_steps - static_cast<int>(frames_) + 1);
}

lidar::Frame ScanToMapOdometry::advance(const Prepared& scan) {
  const ScanFeatures& features = scan.features;
  lidar::Frame frame;
  frame.index = frames_;
  frame.stamp = features.stamp;
  frame.points = features.points;
  frame.dropped = features.dropped;
  frame.class_counts = features.class_counts;
  frame.ms = scan.ms;

  if (frames_ > 0) {
    const double dt = sensors::scan_interval(last_stamp_, features.stamp, profile_);
    const geometry::Pose3 predicted = T_map_last_ * geometry::exp_se3(dt * velocity_);
    Registration registration =
        map_.align(features, predicted, velocity_, steps_of_this_frame(), frame.ms);
    frame.T_map_lidar = registration.T_map_lidar.orthonormalised();
    frame.health = registration.health;
    matches_ = std::move(registration.matches);
    if (registration.health.registered && dt > 0) {
      velocity_ = geometry::log_se3(T_map_last_.inverse() * frame.T_map_lidar) / dt;
    }
  }
  frame.velocity = velocity_;
  // A pose that is only predicted does not shape the map, unless there is no map yet.
  const bool map_is_empty = map_.size() < static_cast<std::size_t>(options_.solver.min_matches);
  if (frame.health.registered || frames_ == 0 || map_is_empty) {
    map_.insert(features, frame.T_map_lidar, velocity_, frame.ms);
  }
  frame.map_points = map_.size();

  T_map_last_ = frame.T_map_lidar;
  last_stamp_ = frame.stamp;
  ++frames_;
  return frame;
}

}  // namespace traverse::loam
