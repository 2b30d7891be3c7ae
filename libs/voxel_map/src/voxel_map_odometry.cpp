#include "traverse/voxel_map/voxel_map_odometry.hpp"

#include <utility>

#include "traverse/lidar/deskew.hpp"
#include "traverse/lidar/stopwatch.hpp"
#include "traverse/parallel/workers.hpp"
#include "traverse/voxel_map/matched_points.hpp"
#include "traverse/voxel_map/row_factor_kinds.hpp"
#include "traverse/voxel_map/used_points.hpp"

namespace traverse::voxel_map {

namespace {

constexpr Effort kFirstFrames{4, 2};

}  // namespace

void bind(config::Binder& b, VoxelMapOdometryOptions& o) {
  using config::Range;
  b.flag("deskew", o.deskew, "undo the motion within a sweep, unless the recording did");
  b.group("sampling", "sampling of a scan's points",
          [&](config::Binder& g) { bind(g, o.sampling); });
  b.group("map", "the local map of planes and lines", [&](config::Binder& g) { bind(g, o.map); });
  b.group("alignment", "solver of the pose", [&](config::Binder& g) { bind(g, o.alignment); });
  b.group("start", "search for the initial speed", [&](config::Binder& g) { bind(g, o.start); });
  b.flag("covariance", o.covariance,
         "covariance of each pose in frames.csv; of a lidar alone it is too small");
  b.integer("first_frames", o.first_frames, Range::between(0, 1000),
            "frames at the start that are registered with a wider gate and more rounds");
}

VoxelMapOdometry::VoxelMapOdometry(const VoxelMapOdometryOptions& options,
                                   const sensors::LidarProfile& profile, bool motion_compensated)
    : options_(options),
      profile_(profile),
      deskew_note_(lidar::deskew_note(options.deskew, profile, motion_compensated)),
      workers_(std::make_shared<parallel::Workers>(options.threads)),
      map_(options.map),
      held_back_(options.start.scans),
      sampler_(options.sampling, profile, deskew_note_ == "on") {}

std::vector<lidar::Frame> VoxelMapOdometry::process(const sensors::LidarScan& scan) {
  return process(sampler_.sample(scan, *workers_));
}

std::vector<lidar::Frame> VoxelMapOdometry::process(SweepSample sample) {
  return advance_all(held_back_.add(std::move(sample)));
}

void VoxelMapOdometry::go_on(const VoxelMap& map, const Known& last) {
  held_back_ = lidar::HeldBack<SweepSample>(0);
  map_ = map;
  frames_ = last.frames;
  last_stamp_ = last.stamp;
  last_middle_s_ = last.middle_s;
  T_map_last_ = last.T_map_middle;
  velocity_ = last.velocity;
  uncertainty_ = LidarUncertainty(last.uncertainty);
}

std::vector<lidar::Frame> VoxelMapOdometry::finish() { return advance_all(held_back_.release()); }

lidar::CorrectedScan VoxelMapOdometry::used_scan(const sensors::LidarScan& scan,
                                                 const geometry::Twist& velocity,
                                                 bool with_classes) const {
  const geometry::Twist motion = deskew_note_ == "on" ? velocity : geometry::Twist::Zero();
  lidar::CorrectedScan used = used_points(scan, profile_, motion);
  if (with_classes) {
    parallel::Workers alone(1);
    used.classes = classes_of(used, sample_sweep(scan, profile_, options_.sampling, alone));
  }
  return used;
}

std::vector<Eigen::Vector3d> VoxelMapOdometry::local_map() const {
  std::vector<Eigen::Vector3d> points = map_.planes().points();
  const std::vector<Eigen::Vector3d> on_lines = map_.lines().points();
  points.insert(points.end(), on_lines.begin(), on_lines.end());
  return points;
}

std::vector<lidar::MatchedPoint> VoxelMapOdometry::matches() const {
  const bool deskew = deskew_note_ == "on";
  return matched_points(matches_, T_map_last_, deskew ? velocity_ : geometry::Twist::Zero());
}

std::vector<optimization::FactorUse> VoxelMapOdometry::factors() const { return row_factors(); }

std::vector<lidar::Frame> VoxelMapOdometry::advance_all(const std::vector<SweepSample>& scans) {
  lidar::Stopwatch watch;
  double start_ms = 0;
  if (frames_ == 0 && scans.size() >= 2) {
    std::vector<double> intervals_s;
    for (std::size_t i = 1; i < scans.size(); ++i) {
      intervals_s.push_back(sampler_.interval(scans[i - 1].stamp, scans[i - 1].middle_s, scans[i]));
    }
    velocity_ = find_initial_velocity(scans, intervals_s, deskew_note_ == "on", options_.map,
                                      options_.alignment, options_.start, *workers_);
    watch.lap(start_ms);
  }
  const bool is_start = frames_ == 0;
  std::vector<lidar::Frame> frames;
  for (const SweepSample& scan : scans) frames.push_back(advance(scan, std::exchange(start_ms, 0)));
  if (is_start && scans.size() >= 3) {
    lidar::Stopwatch settling;
    settle(scans, frames);
    settling.lap(frames.front().ms.start);
  }
  return frames;
}

void VoxelMapOdometry::settle(const std::vector<SweepSample>& scans,
                              std::vector<lidar::Frame>& frames) {
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const lidar::RegistrationHealth& health = frames[i].health;
    if (!health.registered || health.observability.degenerate > 0) return;
  }
  const bool deskew = deskew_note_ == "on";
  const auto motion = [&](std::size_t i) {
    return deskew ? frames[i].velocity : geometry::Twist::Zero();
  };
  const auto middle = [&](std::size_t i) {
    return frames[i].T_map_lidar * geometry::exp_se3(scans[i].middle_s * frames[i].velocity);
  };
  frames[0].velocity = frames[1].velocity;
  VoxelMap others(options_.map);
  for (std::size_t i = 1; i < scans.size(); ++i) {
    others.insert(scans[i], middle(i), motion(i), *workers_);
  }
  const double dt = sampler_.interval(scans[0].stamp, scans[0].middle_s, scans[1]);
  const MotionModel before{middle(0) * geometry::exp_se3(-dt * frames[0].velocity), dt, deskew};
  lidar::StageTimes ignored;
  const Alignment first = align(scans[0], others, before, middle(0), options_.alignment,
                                kFirstFrames, *workers_, matches_, ignored);
  if (!first.health.registered || first.health.observability.degenerate > 0) return;

  const geometry::Pose3 T_old_map =
      first.T_map_lidar * geometry::exp_se3(-scans[0].middle_s * frames[0].velocity);
  const geometry::Pose3 T_map_old = T_old_map.inverse();
  frames[0].T_map_lidar = T_old_map;  // and the origin, once moved as the others are
  map_ = VoxelMap(options_.map);
  uncertainty_ = LidarUncertainty();
  const std::size_t last = scans.size() - 1;
  for (std::size_t i = 0; i < last; ++i) {
    frames[i].T_map_lidar = (T_map_old * frames[i].T_map_lidar).orthonormalised();
    map_.insert(scans[i], middle(i), motion(i), *workers_);
    frames[i].map_points = map_.size();
  }
  frames_ = last;
  T_map_last_ = middle(last - 1);
  last_stamp_ = frames[last - 1].stamp;
  last_middle_s_ = scans[last - 1].middle_s;
  velocity_ = frames[last - 1].velocity;
  frames[last] = advance(scans[last], 0);
}

lidar::Frame VoxelMapOdometry::advance(const SweepSample& sample, double start_ms) {
  lidar::Frame frame;
  frame.index = frames_;
  frame.stamp = sample.stamp;
  frame.points = sample.points;
  frame.dropped = sample.dropped;
  frame.class_counts = sample.class_counts();
  frame.ms.start = start_ms;
  frame.ms.organise = sample.organise_ms;
  frame.ms.features = sample.features_ms;

  const bool deskew = deskew_note_ == "on";
  geometry::Pose3 T_map_middle = geometry::exp_se3(sample.middle_s * velocity_);  // of the sweep
  if (frames_ > 0) {
    const double dt = sampler_.interval(last_stamp_, last_middle_s_, sample);
    const geometry::Pose3 predicted = T_map_last_ * geometry::exp_se3(dt * velocity_);
    const Effort effort =
        frames_ < static_cast<std::size_t>(options_.first_frames) ? kFirstFrames : Effort{};
    const Alignment alignment = align(sample, map_, {T_map_last_, dt, deskew}, predicted,
                                      options_.alignment, effort, *workers_, matches_, frame.ms);
    T_map_middle = alignment.T_map_lidar.orthonormalised();
    frame.health = alignment.health;
    const MotionModel motion{T_map_last_, dt, deskew};
    const geometry::Twist before = velocity_;
    if (frame.health.registered) {
      velocity_ = geometry::log_se3(T_map_last_.inverse() * T_map_middle) / dt;
    }
    if (options_.covariance) {
      lidar::Stopwatch watch;
      if (frame.health.registered) {
        uncertainty_.add(
            scan_evidence(matches_, motion, T_map_middle, options_.alignment.objective),
            frame.health.observability, T_map_middle, velocity_ - before, dt);
      } else {
        uncertainty_.add_predicted(T_map_middle, dt);
      }
      watch.lap(frame.ms.solve);
    }
  }
  frame.velocity = velocity_;
  frame.T_map_lidar = T_map_middle;
  if (sample.middle_s != 0) {
    frame.T_map_lidar = T_map_middle * geometry::exp_se3(-sample.middle_s * velocity_);
  }
  // A pose that is only predicted does not shape the map, unless there is no map yet.
  const auto least = static_cast<std::size_t>(options_.alignment.min_matches);
  if (frame.health.registered || frames_ == 0 || map_.size() < least) {
    lidar::Stopwatch watch;
    map_.insert(sample, T_map_middle, deskew ? velocity_ : geometry::Twist::Zero(), *workers_);
    watch.lap(frame.ms.insert);
  }
  frame.map_points = map_.size();
  if (options_.covariance) frame.covariance = uncertainty_.pose().covariance(T_map_middle);

  T_map_last_ = T_map_middle;
  last_stamp_ = frame.stamp;
  last_middle_s_ = sample.middle_s;
  ++frames_;
  return frame;
}

}  // namespace traverse::voxel_map
