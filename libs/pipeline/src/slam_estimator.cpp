#include "slam_estimator.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "traverse/statistics/quantile.hpp"

namespace traverse::pipeline {

namespace {

constexpr double kUnknownAltitude_m = 1000;  // standard deviation

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

}  // namespace

void bind(config::Binder& b, SlamEstimatorOptions& o) {
  using config::Range;
  b.flag("use", o.use, "close loops; off: odometry alone");
  b.group("gnss", "fixes of the recording's first receiver", [&](config::Binder& g) {
    g.flag("use", o.gnss.use, "constrain the map by GNSS fixes, where there are any");
    g.number("sigma_m", o.gnss.sigma_m, Range::positive(),
             "standard deviation of a fix without covariance");
    g.number("min_sigma_m", o.gnss.min_sigma_m, Range::positive(),
             "smallest standard deviation of a fix that is used");
  });
  b.group("gravity", "direction of gravity by the recording's first IMU", [&](config::Binder& g) {
    g.flag("use", o.gravity.use, "constrain roll and pitch by gravity, where there is an IMU");
    bind(g, o.gravity.finder);
  });
  bind(b, o.slam);
}

SlamEstimator::SlamEstimator(std::unique_ptr<LidarEstimator> odometry,
                             const dataset::RecordingInfo& recording,
                             const SlamEstimatorOptions& options)
    : gnss_(options.gnss),
      odometry_(std::move(odometry)),
      slam_(options.slam, *odometry_->sensor().lidar),
      columns_(odometry_->columns()) {
  columns_.insert(columns_.end(), {"keyframe", "loops", "slam_ms"});
  const auto* imu = recording.rig.first(sensors::SensorKind::kImu);
  if (options.gravity.use && imu != nullptr) {
    imu_ = imu->label;
    gravity_.emplace(options.gravity.finder,
                     odometry_->sensor().T_body_sensor.inverse() * imu->T_body_sensor);
  }
  const auto* receiver = recording.rig.first(sensors::SensorKind::kGnss);
  if (receiver == nullptr) return;
  if (!gnss_.use) {
    unused_receiver_ = receiver->label;
    return;
  }
  if (receiver->label == recording.reference_receiver) {
    unused_receiver_ = receiver->label;
    gnss_note_ = "not used: the reference is made of them";
    return;
  }
  receiver_ = receiver->label;
  antenna_lidar_ =
      odometry_->sensor().T_body_sensor.inverse() * receiver->T_body_sensor.translation;
}

SlamEstimator::SlamEstimator(const SlamEstimator& other)
    : gnss_(other.gnss_),
      receiver_(other.receiver_),
      unused_receiver_(other.unused_receiver_),
      gnss_note_(other.gnss_note_),
      antenna_lidar_(other.antenna_lidar_),
      plane_(other.plane_),
      fixes_(other.fixes_),
      last_frame_(other.last_frame_),
      imu_(other.imu_),
      imu_samples_(other.imu_samples_),
      gravity_(other.gravity_),
      odometry_(other.odometry_->copy()),
      slam_(other.slam_),
      columns_(other.columns_),
      waiting_(other.waiting_) {}

std::unique_ptr<Estimator> SlamEstimator::clone() const {
  return std::unique_ptr<Estimator>(new SlamEstimator(*this));
}

std::vector<PoseFrame> SlamEstimator::process(const sensors::Measurement& measurement) {
  if (const auto* fix = std::get_if<sensors::GnssFix>(&measurement)) take(*fix);
  const auto* imu = std::get_if<sensors::ImuSample>(&measurement);
  if (imu != nullptr && gravity_ && imu->sensor == imu_) {
    gravity_->observe(*imu);
    ++imu_samples_;
  }
  const auto* scan = std::get_if<std::shared_ptr<const sensors::LidarScan>>(&measurement);
  if (scan != nullptr && (*scan)->sensor == odometry_->sensor().label) waiting_.push_back(*scan);
  return close_loops(odometry_->process(measurement));
}

std::vector<PoseFrame> SlamEstimator::finish() {
  std::vector<PoseFrame> frames = close_loops(odometry_->finish());
  slam_.finish();
  return frames;
}

std::vector<PoseFrame> SlamEstimator::close_loops(std::vector<PoseFrame> frames) {
  const std::vector<lidar::Frame>& latest = odometry_->latest();
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto started = std::chrono::steady_clock::now();
    const std::shared_ptr<const sensors::LidarScan> scan = std::move(waiting_.front());
    waiting_.pop_front();
    const std::size_t loops_before = slam_.loops().size();
    const bool wanted = slam_.wants(latest[k]);
    if (wanted) {
      const auto points = odometry_->odometry().used_scan(*scan, latest[k].velocity, false);
      slam_.add(latest[k], *scan, points, odometry_->odometry().deskew_note() == "on");
    }
    place_fixes(latest[k]);
    level(latest[k]);
    const double milliseconds = milliseconds_since(started);
    frames[k].record.push_back(wanted ? 1 : 0);
    frames[k].record.push_back(static_cast<double>(slam_.loops().size() - loops_before));
    frames[k].record.push_back(milliseconds);
    frames[k].milliseconds += milliseconds;
  }
  return frames;
}

void SlamEstimator::take(const sensors::GnssFix& fix) {
  if (receiver_.empty() || fix.sensor != receiver_) return;
  if (!std::isfinite(fix.latitude_deg) || !std::isfinite(fix.longitude_deg)) return;
  // Fixes before the first keyframe have nothing to hold.
  if (slam_.keyframes().size() > 0) fixes_.push_back(fix);
}

/// Fixes come between frames: each counts for the latest keyframe, whose antenna odometry carries
/// to where it was at the moment of the fix.
void SlamEstimator::place_fixes(const lidar::Frame& frame) {
  while (!fixes_.empty() && fixes_.front().stamp <= frame.stamp) {
    const sensors::GnssFix fix = fixes_.front();
    fixes_.pop_front();
    if (!last_frame_ || fix.stamp < last_frame_->stamp) continue;
    const double seconds = geometry::seconds_between(last_frame_->stamp, frame.stamp);
    const double share =  // of frames of one stamp the later
        seconds > 0 ? geometry::seconds_between(last_frame_->stamp, fix.stamp) / seconds : 1;
    place(fix, geometry::interpolate(last_frame_->T_map_lidar, frame.T_map_lidar, share));
  }
  last_frame_ = frame;
}

void SlamEstimator::place(const sensors::GnssFix& fix, const geometry::Pose3& T_odom_lidar) {
  const bool has_altitude = std::isfinite(fix.altitude_m);
  const geodesy::Geodetic place{fix.latitude_deg, fix.longitude_deg,
                                has_altitude ? fix.altitude_m : 0};
  if (!plane_) plane_.emplace(place);
  Eigen::Matrix3d covariance = fix.covariance_enu.value_or(
      Eigen::Matrix3d(gnss_.sigma_m * gnss_.sigma_m * Eigen::Matrix3d::Identity()));
  covariance.diagonal().array() += gnss_.min_sigma_m * gnss_.min_sigma_m;
  if (!has_altitude) covariance(2, 2) += kUnknownAltitude_m * kUnknownAltitude_m;
  const geometry::Pose3 T_keyframe_lidar =
      slam_.chain().T_odom_lidar(slam_.keyframes().size() - 1).inverse() * T_odom_lidar;
  slam_.add_gnss(plane_->to_enu(place), covariance, T_keyframe_lidar * antenna_lidar_);
}

/// A window of time tells of no one keyframe: up counts for the latest, to which odometry carries
/// it.
void SlamEstimator::level(const lidar::Frame& frame) {
  if (!gravity_) return;
  const auto up = gravity_->add(frame);
  if (!up) return;
  const geometry::Pose3& T_odom_lidar = slam_.chain().T_odom_lidar(slam_.keyframes().size() - 1);
  slam_.add_gravity(T_odom_lidar.rotation.transpose() * up->up_odom, up->sigma_rad);
}

std::string SlamEstimator::gravity_note() const {
  const std::vector<pose_graph::Level>& levels = slam_.graph().levels();
  if (levels.empty()) {
    return fmt::format(
        "not used: none found in {} windows of samples of {} with gaps, {} whose "
        "length is not that of gravity",
        gravity_->with_gaps(), imu_, gravity_->turned_away());
  }
  std::vector<double> sigmas_deg;
  double chi2 = 0;
  std::size_t rejected = 0;
  for (const pose_graph::Level& level : levels) {
    sigmas_deg.push_back(level.sigma_rad * 180 / std::numbers::pi);
    chi2 += level.chi2 / (2 * static_cast<double>(levels.size()));
    rejected += level.is_rejected() ? 1 : 0;
  }
  return fmt::format(
      "{} directions of up by {} (sigma {:.3f} deg, chi-square {:.2f} a degree of freedom, {} "
      "rejected), off by {:.3f} deg in common; {} more do not have the length of gravity",
      levels.size(), imu_, statistics::median(sigmas_deg), chi2, rejected,
      slam_.graph().up_offset().norm() * 180 / std::numbers::pi, gravity_->turned_away());
}

std::vector<Decision> SlamEstimator::decisions() const {
  std::vector<Decision> decisions = odometry_->decisions();
  decisions.push_back(
      {"loops", fmt::format("{} of {} candidates accepted, {} keyframes", slam_.accepted_loops(),
                            slam_.loops().size(), slam_.keyframes().size())});
  if (!slam_.failure().empty()) {
    decisions.push_back(
        {"pose graph",
         fmt::format("could not be solved, its poses are those of {}: {}",
                     slam_.is_corrected() ? "the solution before" : "odometry", slam_.failure())});
  }
  if (gravity_) decisions.push_back({"gravity", gravity_note()});
  if (!gnss_note_.empty()) decisions.push_back({"fixes", gnss_note_});
  if (slam_.graph().is_georeferenced()) {
    const geodesy::Geodetic& origin = plane_->origin();
    decisions.push_back(
        {"map frame", fmt::format("ENU, origin {:.9f} deg N, {:.9f} deg E, {:.3f} m; {} fixes",
                                  origin.latitude_deg, origin.longitude_deg, origin.altitude_m,
                                  slam_.graph().fixes().size())});
  }
  return decisions;
}

std::vector<SensorUse> SlamEstimator::sensor_use() const {
  std::vector<SensorUse> uses = odometry_->sensor_use();
  if (gravity_) {
    const auto imu = std::find_if(uses.begin(), uses.end(),
                                  [&](const SensorUse& use) { return use.label == imu_; });
    if (imu != uses.end() && !slam_.graph().levels().empty()) {
      imu->is_taken = true;
      imu->used = imu_samples_;
      imu->reason = "for the direction of up";
    }
  }
  if (!unused_receiver_.empty()) {
    SensorUse fixes{.label = unused_receiver_, .kind = sensors::SensorKind::kGnss};
    fixes.is_taken = false;
    fixes.reason = gnss_note_.empty() ? "switched off (slam.gnss.use)" : gnss_note_;
    uses.push_back(std::move(fixes));
  }
  if (!receiver_.empty()) {
    SensorUse fixes{.label = receiver_, .kind = sensors::SensorKind::kGnss};
    bool orient = false;  // the map: else they are no part of the solution, and none is rejected
    for (const pose_graph::Fix& fix : slam_.graph().fixes()) orient |= fix.weight > 0;
    if (orient) {
      for (const pose_graph::Fix& fix : slam_.graph().fixes()) {
        ++(fix.is_rejected() ? fixes.rejected : fixes.used);
      }
    }
    fixes.is_taken = orient;
    fixes.reason = orient ? "those after a keyframe hold the map"
                          : "they are too near to each other to orient the map";
    uses.push_back(std::move(fixes));
  }
  return uses;
}

std::vector<HealthReason> SlamEstimator::troubles() const {
  std::vector<HealthReason> troubles = odometry_->troubles();
  if (slam_.failure().empty()) return troubles;
  troubles.push_back(
      {Health::kDegraded, "pose_graph",
       fmt::format("The pose graph could not be solved, its poses are those of {}: {}",
                   slam_.is_corrected() ? "the solution before" : "odometry", slam_.failure())});
  return troubles;
}

std::vector<optimization::FactorUse> SlamEstimator::factors() const {
  std::vector<optimization::FactorUse> factors = odometry_->factors();
  const auto of_graph = slam_.graph_factors();
  factors.insert(factors.end(), of_graph.begin(), of_graph.end());
  return factors;
}

}  // namespace traverse::pipeline
