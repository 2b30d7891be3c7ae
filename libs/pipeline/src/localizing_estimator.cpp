#include "localizing_estimator.hpp"

#include <chrono>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/files/input_error.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/pipeline/run_keyframes.hpp"

namespace traverse::pipeline {

namespace {

/// T_map_body from x, y, z and yaw.
geometry::Pose3 start_pose(const std::vector<double>& start) {
  if (start.size() != 4) {
    throw files::InputError("localize.start", files::Place::whole_file(),
                            "x, y, z in metres and yaw in degrees",
                            fmt::format("{} numbers", start.size()));
  }
  geometry::Pose3 T_map_body;
  T_map_body.translation = {start[0], start[1], start[2]};
  T_map_body.rotation = geometry::exp_so3(Eigen::Vector3d(0, 0, start[3] * std::numbers::pi / 180));
  return T_map_body;
}

const std::string& required(const std::string& map) {
  if (map.empty()) {
    throw files::InputError("localize.map", files::Place::whole_file(),
                            "keyframes.simplemap of a run, as `traverse localize --map RUN` gives",
                            "none");
  }
  return map;
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

}  // namespace

void bind(config::Binder& b, LocalizationOptions& o) {
  b.text("map", o.map, "keyframes.simplemap of the run in whose map to localize");
  b.numbers("start", o.start, "x, y, z [m] and yaw [deg] at the first scan; empty: search");
  bind(b, o.search);
}

LocalizingEstimator::LocalizingEstimator(std::unique_ptr<LidarEstimator> odometry,
                                         const LocalizationOptions& options,
                                         const slam::SlamOptions& checks)
    : odometry_(std::move(odometry)),
      map_file_(options.map),
      maker_(checks.keyframes, *odometry_->sensor().lidar),
      localizer_(read_localization_map(required(options.map)), checks, options.search),
      columns_(odometry_->columns()) {
  columns_.insert(columns_.end(), {"located", "fits_map", "map_in_common", "map_residual_rms_m",
                                   "map_keyframe", "localize_ms"});
  if (!options.start.empty()) {
    localizer_.start_at(start_pose(options.start) * odometry_->sensor().T_body_sensor);
  }
}

LocalizingEstimator::LocalizingEstimator(const LocalizingEstimator& other)
    : odometry_(other.odometry_->copy()),
      map_file_(other.map_file_),
      maker_(other.maker_),
      localizer_(other.localizer_),
      columns_(other.columns_),
      waiting_(other.waiting_),
      unplaced_(other.unplaced_),
      T_map_odom_(other.T_map_odom_),
      located_(other.located_),
      frames_(other.frames_),
      events_(other.events_),
      in_vain_(other.in_vain_) {}

std::unique_ptr<Estimator> LocalizingEstimator::clone() const {
  return std::unique_ptr<Estimator>(new LocalizingEstimator(*this));
}

std::vector<PoseFrame> LocalizingEstimator::process(const sensors::Measurement& measurement) {
  const auto* scan = std::get_if<std::shared_ptr<const sensors::LidarScan>>(&measurement);
  if (scan != nullptr && (*scan)->sensor == odometry_->sensor().label) waiting_.push_back(*scan);
  return locate(odometry_->process(measurement));
}

std::vector<PoseFrame> LocalizingEstimator::finish() {
  std::vector<PoseFrame> frames = locate(odometry_->finish());
  if (events_.empty() && frames_ > 0) {
    std::vector<std::string> reasons;
    for (const auto& [reason, scans] : in_vain_) {
      reasons.push_back(fmt::format("{} {}", scans, reason));
    }
    throw std::runtime_error(fmt::format(
        "none of {} scans was found in the map {} ({}): another place, or too little in common",
        frames_, map_file_, fmt::join(reasons, ", ")));
  }
  // Lost for good: odometry carries on from the last known place, and the record says so.
  for (PoseFrame& frame : std::exchange(unplaced_, {})) {
    frames.push_back(placed(std::move(frame), T_map_odom_));
  }
  return frames;
}

std::vector<PoseFrame> LocalizingEstimator::locate(std::vector<PoseFrame> frames) {
  const std::vector<lidar::Frame>& latest = odometry_->latest();
  std::vector<PoseFrame> told;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto started = std::chrono::steady_clock::now();
    const std::shared_ptr<const sensors::LidarScan> scan = std::move(waiting_.front());
    waiting_.pop_front();
    lidar::CorrectedScan points;  // a place is known by them, but not followed
    if (localizer_.is_searching()) {
      points = odometry_->odometry().used_scan(*scan, latest[k].velocity, false);
    }
    const slam::Localizer::Fix fix = localizer_.locate(
        maker_.make(latest[k], *scan, points, odometry_->odometry().deskew_note() == "on"));
    note(fix);
    ++frames_;
    const double milliseconds = milliseconds_since(started);
    PoseFrame frame = std::move(frames[k]);
    frame.record.insert(frame.record.end(),
                        {fix.located ? 1.0 : 0.0, fix.fits() ? 1.0 : 0.0, fix.in_common,
                         fix.residual_rms_m, static_cast<double>(fix.keyframe), milliseconds});
    frame.milliseconds += milliseconds;
    if (!fix.located) {
      unplaced_.push_back(std::move(frame));
      continue;
    }
    T_map_odom_ = fix.T_map_odom;
    for (PoseFrame& earlier : std::exchange(unplaced_, {})) {
      told.push_back(placed(std::move(earlier), T_map_odom_));
    }
    told.push_back(placed(std::move(frame), T_map_odom_));
  }
  return told;
}

void LocalizingEstimator::note(const slam::Localizer::Fix& fix) {
  if (fix.located && !located_) {
    events_.push_back(fmt::format("found in frame {}", frames_));
  } else if (!fix.located && located_) {
    events_.push_back(fmt::format("lost in frame {} ({})", frames_, name_of(fix.verdict)));
  } else if (!fix.located) {
    ++in_vain_[std::string(name_of(fix.verdict))];
  }
  located_ = fix.located;
}

PoseFrame LocalizingEstimator::placed(PoseFrame frame, const geometry::Pose3& T_map_odom) const {
  const geometry::Pose3& T_body_lidar = odometry_->sensor().T_body_sensor;
  const geometry::Pose3 T_odom_lidar = T_body_lidar.inverse() * frame.T_map_body * T_body_lidar;
  frame.T_map_body = T_map_odom * T_odom_lidar * T_body_lidar.inverse();
  return frame;
}

std::vector<Decision> LocalizingEstimator::decisions() const {
  std::vector<Decision> decisions = odometry_->decisions();
  decisions.push_back({"map", map_file_});
  decisions.push_back(
      {"place", events_.empty() ? "not found" : fmt::format("{}", fmt::join(events_, ", "))});
  return decisions;
}

}  // namespace traverse::pipeline
