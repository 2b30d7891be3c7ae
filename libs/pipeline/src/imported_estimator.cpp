#include "imported_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/lidar/deskew.hpp"
#include "traverse/sensors/sweep_timing.hpp"
#include "traverse/voxel_map/used_points.hpp"

namespace traverse::pipeline {

namespace {

using geometry::seconds_between;

sensors::MountedSensor lidar_to_place(const dataset::RecordingInfo& recording) {
  const sensors::MountedSensor* sensor = recording.rig.first(sensors::SensorKind::kLidar);
  if (sensor != nullptr && sensor->lidar) return *sensor;
  throw std::runtime_error(
      recording.path.string() +
      ": no 3-D lidar in this recording, whose scans poses would be given to; `traverse evaluate` "
      "compares trajectories without a recording");
}

/// When the first and the last point of a sweep were seen, seconds after its stamp; of every so
/// manieth point, whose times are at most a degree of a turn off.
std::pair<double, double> span_of(const sensors::LidarScan& scan,
                                  const sensors::LidarProfile& profile) {
  constexpr std::size_t kEvery = 16;
  const sensors::PointClock clock(scan, profile);
  if (!clock.knows() || scan.size() == 0) return {0, 0};
  double begin_s = clock(0);
  double end_s = begin_s;
  for (std::size_t i = 0; i < scan.size(); i += kEvery) {
    const double time_s = clock(i);
    if (!std::isfinite(time_s)) continue;
    begin_s = std::min(begin_s, time_s);
    end_s = std::max(end_s, time_s);
  }
  return {begin_s, end_s};
}

}  // namespace

ImportedEstimator::ImportedEstimator(const ImportOptions& options,
                                     const dataset::RecordingInfo& recording)
    : options_(options),
      sensor_(lidar_to_place(recording)),
      deskew_note_(
          lidar::deskew_note(options.deskew, *sensor_.lidar, recording.motion_compensated)),
      first_scan_(static_cast<std::size_t>(options.first_scan)),
      next_scan_(first_scan_) {
  auto poses = std::make_shared<ImportedPoses>();
  // A replay has the poses from the run folder, whose scans it corrects as the run did.
  if (!options.file.empty()) *poses = read_imported_poses(options, recording);
  if (!options.timing.empty()) {
    timing_ = read_foreign_timing(options.timing, poses->T_map_body.size());
  }
  poses_ = std::move(poses);
}

const std::vector<std::string>& ImportedEstimator::columns() const {
  static const std::vector<std::string> kColumns{"interpolated", "speed_mps"};
  return kColumns;
}

std::vector<PoseFrame> ImportedEstimator::process(const sensors::Measurement& measurement) {
  const auto* scan = std::get_if<std::shared_ptr<const sensors::LidarScan>>(&measurement);
  if (scan == nullptr || (*scan)->sensor != sensor_.label) return {};
  return take(**scan);
}

std::vector<PoseFrame> ImportedEstimator::take(const sensors::LidarScan& scan) {
  const std::size_t number = next_scan_++;
  if (scans() == 1) first_stamp_ = scan.stamp;
  last_stamp_ = scan.stamp;
  std::optional<PoseFrame> frame = frame_at(scan.stamp, number);
  std::vector<PoseFrame> told;
  if (waiting_) told.push_back(released(*std::exchange(waiting_, std::nullopt)));
  if (!frame) return told;
  const auto [begin_s, end_s] = span_of(scan, *sensor_.lidar);
  waiting_ = Waiting{std::move(*frame), begin_s, end_s};
  return told;
}

std::vector<PoseFrame> ImportedEstimator::finish() {
  if (scans() > 0 && taken_ + interpolated_ == 0 && !options_.file.empty()) require_a_pose();
  if (!waiting_) return {};
  return {released(*std::exchange(waiting_, std::nullopt))};
}

void ImportedEstimator::require_a_pose() const {
  if (!poses_->scans.empty()) {
    throw std::runtime_error(
        fmt::format("{}: expected poses of scans {} to {}, found those of {} to {}", options_.file,
                    first_scan_, next_scan_ - 1, poses_->scans.front(), poses_->scans.back()));
  }
  const geometry::Trajectory& path = poses_->T_map_body;
  throw std::runtime_error(fmt::format(
      "{}: expected poses at the times of the scans, {} to {} s, found poses of {} to {} s, at "
      "most "
      "{:g} s of which are interpolated over; another clock: --time-offset SECONDS, or auto",
      options_.file, to_text(first_stamp_), to_text(last_stamp_), to_text(path.stamp(0)),
      to_text(path.stamp(path.size() - 1)), options_.max_gap_s));
}

std::optional<PoseFrame> ImportedEstimator::frame_at(geometry::Stamp stamp, std::size_t number) {
  const geometry::Trajectory& path = poses_->T_map_body;
  const bool by_number = !poses_->scans.empty();
  std::optional<geometry::Pose3> pose;
  std::size_t index = 0;  // of the pose at the scan or after it
  bool is_between = false;
  if (by_number) {
    const auto found = std::lower_bound(poses_->scans.begin(), poses_->scans.end(), number);
    index = static_cast<std::size_t>(found - poses_->scans.begin());
    if (found == poses_->scans.end()) {
      ++after_;
    } else if (*found == number) {
      pose = path.pose(index);
      placed_.push_back(stamp, *pose);
    } else {
      ++(index == 0 ? before_ : in_gaps_);
    }
  } else {
    const auto found = std::lower_bound(path.stamps().begin(), path.stamps().end(), stamp);
    index = static_cast<std::size_t>(found - path.stamps().begin());
    is_between = found != path.stamps().end() && *found != stamp;
    pose = path.at(stamp, options_.max_gap_s);
    if (found == path.stamps().end()) {
      ++after_;
    } else if (!pose) {
      ++(index == 0 ? before_ : in_gaps_);
    } else if (is_between) {
      widest_s_ = std::max(widest_s_, seconds_between(path.stamp(index - 1), path.stamp(index)));
    }
  }
  if (!pose) return std::nullopt;
  ++(is_between ? interpolated_ : taken_);
  PoseFrame frame;
  frame.stamp = stamp;
  frame.T_map_body = *pose;
  if (!timing_.frame_ms.empty()) frame.milliseconds = timing_.frame_ms[index];
  frame.record = {is_between ? 1.0 : 0.0, 0};
  return frame;
}

geometry::Twist ImportedEstimator::velocity_over(geometry::Stamp stamp, double begin_s,
                                                 double end_s) const {
  constexpr double kLeast_s = 1e-3;
  const geometry::Trajectory& path = poses_->scans.empty() ? poses_->T_map_body : placed_;
  if (path.size() < 2) return geometry::Twist::Zero();
  // Where sweeps have no times, over the time to the neighbours.
  if (end_s - begin_s < kLeast_s) {
    const auto found = std::lower_bound(path.stamps().begin(), path.stamps().end(), stamp);
    const auto i = static_cast<std::size_t>(found - path.stamps().begin());
    begin_s = i > 0 ? -std::min(options_.max_gap_s, seconds_between(path.stamp(i - 1), stamp)) : 0;
    end_s = i + 1 < path.size()
                ? std::min(options_.max_gap_s, seconds_between(stamp, path.stamp(i + 1)))
                : 0;
  }
  const geometry::Stamp begin = std::max(geometry::shifted(stamp, begin_s), path.stamp(0));
  const geometry::Stamp end =
      std::min(geometry::shifted(stamp, end_s), path.stamp(path.size() - 1));
  const double seconds = seconds_between(begin, end);
  if (seconds < kLeast_s) return geometry::Twist::Zero();
  const auto first = path.at(begin, options_.max_gap_s);
  const auto last = path.at(end, options_.max_gap_s);
  if (!first || !last) return geometry::Twist::Zero();
  return geometry::log_se3(first->inverse() * *last) / seconds;
}

PoseFrame ImportedEstimator::released(Waiting waiting) const {
  PoseFrame frame = std::move(waiting.frame);
  frame.velocity = velocity_over(frame.stamp, waiting.begin_s, waiting.end_s);
  frame.record.back() = frame.velocity.tail<3>().norm();
  return frame;
}

UsedScan ImportedEstimator::used_scan(const sensors::LidarScan& scan, const PoseFrame& frame,
                                      bool /*with_classes*/) const {
  const geometry::Pose3& T_body_sensor = sensor_.T_body_sensor;
  const geometry::Pose3 T_sensor_body = T_body_sensor.inverse();
  geometry::Twist velocity = geometry::Twist::Zero();  // of the lidar
  if (deskew_note_ == "on") {
    velocity.head<3>() = T_sensor_body.rotation * frame.velocity.head<3>();
    velocity.tail<3>() = T_sensor_body.rotation * frame.velocity.tail<3>() +
                         T_sensor_body.translation.cross(Eigen::Vector3d(velocity.head<3>()));
  }
  const lidar::CorrectedScan points = voxel_map::used_points(scan, *sensor_.lidar, velocity);
  UsedScan used;
  const auto scale = static_cast<float>(1 / sensor_.lidar->intensity_full_scale);
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    const Eigen::Vector3f p =
        (T_body_sensor * Eigen::Vector3d(points.x[i], points.y[i], points.z[i])).cast<float>();
    used.x.push_back(p.x());
    used.y.push_back(p.y());
    used.z.push_back(p.z());
    if (!scan.intensity.empty()) used.intensity.push_back(scan.intensity[points.source[i]] * scale);
  }
  used.source = points.source;
  return used;
}

std::string ImportedEstimator::points_are() const {
  const double correction = sensor_.lidar->vertical_correction_deg;
  const std::string elevation =
      correction == 0 ? "" : fmt::format("elevation corrected by {:+g} deg, ", correction);
  return elevation + (deskew_note_ == "on" ? "deskewed by the given poses" : "not deskewed");
}

std::vector<Decision> ImportedEstimator::decisions() const {
  std::vector<Decision> list{
      {"lidar", fmt::format("{} ({})", sensor_.label, sensor_.lidar->name)},
      {"poses",
       fmt::format("{} of {}: {}", poses_->T_map_body.size(), options_.file, poses_->read_as)},
      {"frame", fmt::format("{}{}", options_.frame,
                            options_.extrinsic.empty() ? ", as stated or by default"
                                                       : ", with the extrinsic that was given")}};
  for (const std::string& note : poses_->notes) list.push_back({"poses", note});
  if (!poses_->scans.empty()) {
    list.push_back({"matched", "by number: the poses have no stamps"});
  } else {
    list.push_back({"clock", fmt::format("{:+.6f} s added to the stamps of the poses, {}",
                                         options_.time_offset_s, options_.time_offset_reason)});
  }
  if (scans() > 0) {
    std::vector<std::string> parts{fmt::format("{} at a pose", taken_)};
    if (interpolated_ > 0) {
      parts.push_back(fmt::format("{} between poses at most {:.3g} s apart (allowed: {:g} s)",
                                  interpolated_, widest_s_, options_.max_gap_s));
    }
    if (before_ > 0) parts.push_back(fmt::format("{} before the first pose", before_));
    if (after_ > 0) parts.push_back(fmt::format("{} after the last pose", after_));
    if (in_gaps_ > 0) {
      parts.push_back(poses_->scans.empty()
                          ? fmt::format("{} where poses are more than {:g} s apart", in_gaps_,
                                        options_.max_gap_s)
                          : fmt::format("{} whose number has no pose", in_gaps_));
    }
    list.push_back({"scans", fmt::format("{}: {}", scans(), fmt::join(parts, ", "))});
  }
  list.push_back({"deskew", deskew_note_});
  list.push_back({"points", points_are()});
  return list;
}

std::vector<SensorUse> ImportedEstimator::sensor_use() const {
  SensorUse use{.label = sensor_.label, .kind = sensors::SensorKind::kLidar};
  use.used = taken_ + interpolated_;
  use.rejected = scans() - use.used;
  if (use.rejected > 0) use.reason = "have no pose";
  return {std::move(use)};
}

std::vector<HealthReason> ImportedEstimator::troubles() const {
  const std::size_t without = before_ + after_ + in_gaps_;
  constexpr std::size_t kTenth = 10;
  if (without * kTenth <= scans()) return {};
  return {{Health::kDegraded, "without_pose",
           fmt::format("{} of {} scans have no pose: {} before the first, {} after the last, {} "
                       "between poses that are too far apart.",
                       without, scans(), before_, after_, in_gaps_)}};
}

}  // namespace traverse::pipeline
