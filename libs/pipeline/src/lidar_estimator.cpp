#include "lidar_estimator.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "traverse/geometry/se3.hpp"

namespace traverse::pipeline {

namespace {

const sensors::MountedSensor& first_lidar(const dataset::RecordingInfo& recording) {
  const sensors::MountedSensor* sensor = recording.rig.first(sensors::SensorKind::kLidar);
  if (sensor == nullptr || !sensor->lidar) {
    throw std::runtime_error(recording.path.string() +
                             ": no 3-D lidar in this recording, which lidar odometry needs");
  }
  return *sensor;
}

/// The health record of a frame: its columns and their values are named in this one place.
template <typename Add>
void for_each_value(const lidar::Frame& frame, const Add& add) {
  using lidar::FeatureClass;
  const auto count = [](std::size_t n) { return static_cast<double>(n); };
  const auto classified = [&](FeatureClass c) {
    return count(frame.class_counts[static_cast<std::size_t>(c)]);
  };
  add("points", count(frame.points));
  add("dropped_not_finite", count(frame.dropped.not_finite));
  add("dropped_at_origin", count(frame.dropped.at_origin));
  add("dropped_out_of_range", count(frame.dropped.out_of_range));
  add("dropped_beyond_rings", count(frame.dropped.beyond_profile_rings));
  add("sharp", classified(FeatureClass::kSharp));
  add("less_sharp", classified(FeatureClass::kLessSharp));
  add("flat", classified(FeatureClass::kFlat));
  add("less_flat", classified(FeatureClass::kLessFlat));

  const lidar::RegistrationHealth& health = frame.health;
  add("registered", health.registered ? 1 : 0);
  add("line_matches", count(health.line_matches));
  add("plane_matches", count(health.plane_matches));
  add("residual_rms_m", health.residual_rms_m);
  add("inlier_share", health.inlier_share);
  add("registration_steps", health.steps);
  add("solver_iterations", health.iterations);
  add("converged", health.converged ? 1 : 0);
  add("degenerate_directions", health.observability.degenerate);
  add("rotation_scale_m", health.observability.rotation_scale_m);
  static constexpr std::array<std::string_view, 6> kAxes{"rx", "ry", "rz", "tx", "ty", "tz"};
  for (Eigen::Index k = 0; k < 6; ++k) {
    add(fmt::format("eigenvalue_{}", k + 1), health.observability.eigenvalues[k]);
  }
  for (Eigen::Index k = 0; k < 6; ++k) {
    add(fmt::format("weakest_direction_{}", kAxes[static_cast<std::size_t>(k)]),
        health.observability.directions(k, 0));
  }
  add("map_points", count(frame.map_points));
  add("speed_mps", frame.velocity.tail<3>().norm());

  add("start_ms", frame.ms.start);
  add("organise_ms", frame.ms.organise);
  add("features_ms", frame.ms.features);
  add("deskew_ms", frame.ms.deskew);
  add("index_ms", frame.ms.index);
  add("associate_ms", frame.ms.associate);
  add("solve_ms", frame.ms.solve);
  add("insert_ms", frame.ms.insert);
}

/// Upper triangle of a covariance of (rotation, translation), in this one place.
template <typename Add>
void for_each_entry(const geometry::Matrix6& covariance, const Add& add) {
  static constexpr std::array<std::string_view, 6> kAxes{"rx", "ry", "rz", "tx", "ty", "tz"};
  for (Eigen::Index i = 0; i < 6; ++i) {
    for (Eigen::Index j = i; j < 6; ++j) {
      add(fmt::format("covariance_{}_{}", kAxes[static_cast<std::size_t>(i)],
                      kAxes[static_cast<std::size_t>(j)]),
          covariance(i, j));
    }
  }
}

/// The body twist of a rigid vehicle from that of a sensor on it: the adjoint of T_body_sensor.
geometry::Twist moved_to_body(const geometry::Twist& velocity_sensor,
                              const geometry::Pose3& T_body_sensor) {
  geometry::Twist velocity;
  velocity.head<3>() = T_body_sensor.rotation * velocity_sensor.head<3>();
  velocity.tail<3>() = T_body_sensor.rotation * velocity_sensor.tail<3>() +
                       T_body_sensor.translation.cross(Eigen::Vector3d(velocity.head<3>()));
  return velocity;
}

}  // namespace

LidarEstimator::LidarEstimator(const MakeOdometry& make, const dataset::RecordingInfo& recording)
    : sensor_(first_lidar(recording)),
      odometry_(make(*sensor_.lidar, recording.motion_compensated)),
      has_times_(recording.motion_compensated ||
                 sensor_.lidar->time_source != sensors::TimeSource::kNone) {
  odometry_->mount(recording.rig, sensor_);
  for_each_value(lidar::Frame{},
                 [&](std::string_view name, double) { columns_.emplace_back(name); });
  if (odometry_->tells_covariance()) {
    for_each_entry(geometry::Matrix6::Zero(),
                   [&](std::string name, double) { columns_.push_back(std::move(name)); });
  }
  const auto& further = odometry_->further_columns();
  columns_.insert(columns_.end(), further.begin(), further.end());
  if (const auto* imu = recording.rig.first(sensors::SensorKind::kImu)) {
    imu_ = imu->label;
    T_lidar_imu_ = sensor_.T_body_sensor.inverse() * imu->T_body_sensor;
  }
  if (const auto* wheels = recording.rig.first(sensors::SensorKind::kWheels)) {
    wheels_ = wheels->label;
  }
}

LidarEstimator::LidarEstimator(const LidarEstimator& other)
    : sensor_(other.sensor_),
      T_lidar_imu_(other.T_lidar_imu_),
      imu_(other.imu_),
      wheels_(other.wheels_),
      odometry_(other.odometry_->clone()),
      columns_(other.columns_),
      latest_(other.latest_),
      frames_(other.frames_),
      not_registered_(other.not_registered_),
      imu_samples_(other.imu_samples_),
      wheel_readings_(other.wheel_readings_),
      has_times_(other.has_times_),
      path_m_(other.path_m_),
      last_position_(other.last_position_) {}

std::unique_ptr<LidarEstimator> LidarEstimator::copy() const {
  return std::unique_ptr<LidarEstimator>(new LidarEstimator(*this));
}

std::unique_ptr<Estimator> LidarEstimator::clone() const { return copy(); }

std::vector<Eigen::Vector3d> LidarEstimator::local_map() const {
  std::vector<Eigen::Vector3d> points = odometry_->local_map();
  for (Eigen::Vector3d& p : points) p = sensor_.T_body_sensor * p;
  return points;
}

std::vector<MatchedPoint> LidarEstimator::matches() const {
  std::vector<MatchedPoint> points;
  for (const lidar::MatchedPoint& match : odometry_->matches()) {
    points.push_back({match.kind == lidar::MatchedPoint::Kind::kLine,
                      sensor_.T_body_sensor * match.p_map, sensor_.T_body_sensor * match.foot_map,
                      sensor_.T_body_sensor.rotation * match.direction, match.residual_m});
  }
  return points;
}

const std::vector<std::string>& LidarEstimator::columns() const { return columns_; }

std::vector<PoseFrame> LidarEstimator::process(const sensors::Measurement& measurement) {
  if (const auto* imu = std::get_if<sensors::ImuSample>(&measurement)) {
    observe(*imu);
    return {};
  }
  if (const auto* wheels = std::get_if<sensors::WheelOdometry>(&measurement)) {
    if (wheels->sensor != wheels_) return {};
    ++wheel_readings_;
    odometry_->observe_wheels(*wheels);
    return {};
  }
  const auto* scan = std::get_if<std::shared_ptr<const sensors::LidarScan>>(&measurement);
  if (scan == nullptr || (*scan)->sensor != sensor_.label) return {};
  return to_body(odometry_->process(**scan));
}

void LidarEstimator::observe(const sensors::ImuSample& sample) {
  if (sample.sensor != imu_) return;
  ++imu_samples_;
  sensors::ImuSample turned = sample;
  turned.angular_rate = T_lidar_imu_.rotation * sample.angular_rate;
  turned.specific_force = T_lidar_imu_.rotation * sample.specific_force;
  odometry_->observe(turned);
}

std::vector<PoseFrame> LidarEstimator::finish() { return to_body(odometry_->finish()); }

std::vector<PoseFrame> LidarEstimator::to_body(std::vector<lidar::Frame> frames) {
  latest_ = std::move(frames);
  std::vector<PoseFrame> result;
  for (const lidar::Frame& frame : latest_) {
    const Eigen::Vector3d& position = frame.T_map_lidar.translation;
    if (frames_ > 0) path_m_ += (position - last_position_).norm();
    last_position_ = position;
    not_registered_ += frames_ > 0 && !frame.health.registered ? 1 : 0;
    ++frames_;
    PoseFrame pose;
    pose.stamp = frame.stamp;
    pose.T_map_body = sensor_.T_body_sensor * frame.T_map_lidar * sensor_.T_body_sensor.inverse();
    pose.velocity = moved_to_body(frame.velocity, sensor_.T_body_sensor);
    pose.milliseconds = frame.ms.total();
    for_each_value(frame, [&](std::string_view, double value) { pose.record.push_back(value); });
    if (odometry_->tells_covariance()) {
      const geometry::Matrix6 to_body = geometry::adjoint(sensor_.T_body_sensor);
      const geometry::Matrix6 covariance =
          frame.covariance.value_or(geometry::Matrix6(geometry::Matrix6::Zero()));
      for_each_entry(to_body * covariance * to_body.transpose(),
                     [&](const std::string&, double value) { pose.record.push_back(value); });
    }
    pose.record.insert(pose.record.end(), frame.further.begin(), frame.further.end());
    result.push_back(std::move(pose));
  }
  return result;
}

UsedScan LidarEstimator::used_scan(const sensors::LidarScan& scan, const PoseFrame& frame,
                                   bool with_classes) const {
  const geometry::Pose3 T_sensor_body = sensor_.T_body_sensor.inverse();
  const lidar::CorrectedScan points =
      odometry_->used_scan(scan, moved_to_body(frame.velocity, T_sensor_body), with_classes);

  UsedScan used;
  for (auto* values : {&used.x, &used.y, &used.z}) values->reserve(points.x.size());
  const auto scale = static_cast<float>(1 / sensor_.lidar->intensity_full_scale);
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    const Eigen::Vector3f p =
        (sensor_.T_body_sensor * Eigen::Vector3d(points.x[i], points.y[i], points.z[i]))
            .cast<float>();
    used.x.push_back(p.x());
    used.y.push_back(p.y());
    used.z.push_back(p.z());
    const std::uint32_t source = points.source[i];
    if (!scan.intensity.empty()) used.intensity.push_back(scan.intensity[source] * scale);
  }
  used.source = points.source;
  for (const lidar::FeatureClass c : points.classes) {
    used.feature_class.push_back(static_cast<std::uint8_t>(c));
  }
  return used;
}

std::string LidarEstimator::points_are() const {
  const double correction = sensor_.lidar->vertical_correction_deg;
  const std::string elevation =
      correction == 0 ? "" : fmt::format("elevation corrected by {:+g} deg, ", correction);
  return elevation + (odometry_->deskew_note() == "on" ? "deskewed" : "not deskewed");
}

std::vector<SensorUse> LidarEstimator::sensor_use() const {
  SensorUse scans{.label = sensor_.label, .kind = sensors::SensorKind::kLidar};
  scans.used = frames_ - not_registered_;
  scans.rejected = not_registered_;
  if (not_registered_ > 0) scans.reason = "could not be registered";
  std::vector<SensorUse> uses{std::move(scans)};
  if (!imu_.empty()) {
    SensorUse imu{.label = imu_, .kind = sensors::SensorKind::kImu};
    imu.is_taken = odometry_->uses_imu();
    if (imu.is_taken) {
      imu.used = imu_samples_;
    } else {
      imu.reason = "the odometry uses no IMU";
    }
    uses.push_back(std::move(imu));
  }
  if (!wheels_.empty() && odometry_->uses_wheels()) {
    SensorUse wheels{.label = wheels_, .kind = sensors::SensorKind::kWheels};
    wheels.used = wheel_readings_;
    uses.push_back(std::move(wheels));
  }
  return uses;
}

std::vector<HealthReason> LidarEstimator::troubles() const {
  constexpr double kBlur_m = 0.1;  // several times what ranges are off by
  std::vector<HealthReason> reasons;
  for (const lidar::Note& note : odometry_->notes()) {
    if (!note.is_trouble) continue;
    reasons.push_back({Health::kDegraded, "imu_not_used", note.name + ": " + note.value + "."});
  }
  if (has_times_ || frames_ < 2) return reasons;
  const double in_a_scan_m = path_m_ / static_cast<double>(frames_ - 1);
  if (in_a_scan_m <= kBlur_m) return reasons;
  reasons.push_back(
      {Health::kDegraded, "not_deskewed",
       fmt::format("The lidar moves by {:.2g} m from scan to scan, and scans are used as if it "
                   "stood: the times of their points are unknown (deskewed already: "
                   "--recording motion_compensated=true).",
                   in_a_scan_m)});
  return reasons;
}

std::vector<Decision> LidarEstimator::decisions() const {
  std::vector<Decision> decisions{
      {"lidar", fmt::format("{} ({})", sensor_.label, sensor_.lidar->name)},
      {"deskew", odometry_->deskew_note()},
      {"points", points_are()}};
  for (lidar::Note& note : odometry_->notes()) {
    decisions.push_back({std::move(note.name), std::move(note.value), note.is_told});
  }
  return decisions;
}

}  // namespace traverse::pipeline
