#include "navigation_estimator.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string_view>
#include <variant>

#include <fmt/format.h>

#include "traverse/inertial/factor_kinds.hpp"

namespace traverse::pipeline {

namespace {

using inertial::Innovation;
using inertial::NavFrame;
using inertial::NavState;
using sensors::SensorKind;

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kNotMeasured = -1;

const sensors::MountedSensor& imu_of(const dataset::RecordingInfo& recording) {
  const auto* imu = recording.rig.first(SensorKind::kImu);
  if (imu == nullptr) {
    throw std::runtime_error(recording.path.string() +
                             ": no IMU in this recording, which navigation needs");
  }
  return *imu;
}

std::string label_of(const dataset::RecordingInfo& recording, SensorKind kind) {
  const auto* sensor = recording.rig.first(kind);
  return sensor == nullptr ? std::string() : sensor->label;
}

inertial::Mounts mounts_of(const dataset::RecordingInfo& recording) {
  const Eigen::Vector3d p_imu = imu_of(recording).T_body_sensor.translation;
  inertial::Mounts mounts;
  if (const auto* gnss = recording.rig.first(SensorKind::kGnss)) {
    mounts.antenna_body = gnss->T_body_sensor.translation - p_imu;
    const Eigen::Matrix3d& R = gnss->T_body_sensor.rotation;
    mounts.baseline_angle = std::atan2(R(1, 0), R(0, 0));
  }
  if (const auto* wheels = recording.rig.first(SensorKind::kWheels)) {
    mounts.wheels.p_body = wheels->T_body_sensor.translation - p_imu;
    mounts.wheels.R_wheels_body = wheels->T_body_sensor.rotation.transpose();
    mounts.encoder = wheels->encoder;
  }
  return mounts;
}

/// Without a receiver there is no fix to wait for.
inertial::NavigationOptions fitted(inertial::NavigationOptions options,
                                   const dataset::RecordingInfo& recording) {
  if (recording.rig.first(SensorKind::kGnss) == nullptr) options.start.gnss_wait_s = 0;
  return options;
}

/// What the record of a frame needs beside it.
struct Beside {
  /// The antenna from the body whose poses are told, in its axes [m]: a fix is told where it puts
  /// that body, to stand beside the path.
  Eigen::Vector3d p_antenna_told = Eigen::Vector3d::Zero();
  double roughness_m = kNotMeasured;
  bool is_smoothed = false;  ///< the path is told when later readings have had their say
};

/// The health record of a frame: its columns and their values are named in this one place. What was
/// not measured is -1, as neither chi-square nor a length ever is.
template <typename Add>
void for_each_value(const NavFrame& frame, const Beside& beside, const Add& add) {
  const auto chi2 = [&](const char* name, const Innovation& found) {
    add(fmt::format("{}_chi2", name), found.rows > 0 ? found.chi2 : kNotMeasured);
    add(fmt::format("{}_rows", name), found.rows);
    add(fmt::format("{}_rejected", name), found.is_rejected ? 1 : 0);
  };
  add("by_gnss", frame.by_gnss ? 1 : 0);
  add("by_wheels", frame.by_wheels ? 1 : 0);
  add("in_outage", frame.in_outage ? 1 : 0);
  add("restarted", frame.restarted ? 1 : 0);
  chi2("gnss", frame.gnss);
  chi2("heading", frame.heading);
  chi2("wheels", frame.wheels);
  chi2("standing", frame.standing);
  chi2("inertial", frame.inertial);
  add("gnss_residual_east_m", frame.gnss_residual_enu.x());
  add("gnss_residual_north_m", frame.gnss_residual_enu.y());
  add("gnss_residual_up_m", frame.gnss_residual_enu.z());
  const bool has_fix = frame.gnss.rows > 0;
  const Eigen::Vector3d p_fix =
      frame.p_antenna_fix_map - frame.state.q_map_body * beside.p_antenna_told;
  add("fix_east_m", has_fix ? p_fix.x() : 0);
  add("fix_north_m", has_fix ? p_fix.y() : 0);
  add("fix_up_m", has_fix ? p_fix.z() : 0);
  add("correction_m", beside.is_smoothed ? kNotMeasured : frame.correction_map.norm());
  add("roughness_m", beside.roughness_m);

  const auto sigma = [&](int part) { return std::sqrt(frame.covariance(part, part)); };
  static constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    const auto axis = kAxes[static_cast<std::size_t>(k)];
    add(fmt::format("gyro_bias_{}_rad_s", axis), frame.state.gyro_bias[k]);
    add(fmt::format("gyro_bias_{}_sigma", axis), sigma(NavState::kGyroBias + k));
    add(fmt::format("accelerometer_bias_{}_m_s2", axis), frame.state.accelerometer_bias[k]);
    add(fmt::format("accelerometer_bias_{}_sigma", axis), sigma(NavState::kAccelerometerBias + k));
  }
  add("sigma_east_m", sigma(NavState::kPosition));
  add("sigma_north_m", sigma(NavState::kPosition + 1));
  add("sigma_up_m", sigma(NavState::kPosition + 2));
  const Eigen::Matrix3d R = frame.state.rotation();
  add("roll_deg", std::atan2(R(2, 1), R(2, 2)) * kDegrees);
  add("pitch_deg", std::asin(std::clamp(-R(2, 0), -1.0, 1.0)) * kDegrees);
  add("heading_deg", std::fmod(450 - std::atan2(R(1, 0), R(0, 0)) * kDegrees, 360));
  add("sigma_roll_deg", sigma(NavState::kRotation) * kDegrees);
  add("sigma_pitch_deg", sigma(NavState::kRotation + 1) * kDegrees);
  add("sigma_heading_deg", sigma(NavState::kRotation + 2) * kDegrees);
  add("velocity_east_mps", frame.state.v_map.x());
  add("velocity_north_mps", frame.state.v_map.y());
  add("velocity_up_mps", frame.state.v_map.z());
  add("sigma_velocity_east_mps", sigma(NavState::kVelocity));
  add("sigma_velocity_north_mps", sigma(NavState::kVelocity + 1));
  add("sigma_velocity_up_mps", sigma(NavState::kVelocity + 2));
  add("wheel_scale", frame.state.wheel_scale);
  add("wheel_scale_sigma", sigma(NavState::kWheelScale));
  add("wheel_pitch_deg", frame.state.wheel_turn[0] * kDegrees);
  add("wheel_pitch_sigma", sigma(NavState::kWheelTurn) * kDegrees);
  add("wheel_yaw_deg", frame.state.wheel_turn[1] * kDegrees);
  add("wheel_yaw_sigma", sigma(NavState::kWheelTurn + 1) * kDegrees);
  add("gnss_latency_s", frame.state.gnss_latency);
  add("gnss_latency_sigma", sigma(NavState::kGnssLatency));
  static constexpr std::array<std::string_view, 3> kDirections{"east", "north", "up"};
  for (int k = 0; k < 3; ++k) {
    const auto direction = kDirections[static_cast<std::size_t>(k)];
    add(fmt::format("gnss_bias_{}_m", direction), frame.state.gnss_bias[k]);
    add(fmt::format("gnss_bias_{}_sigma", direction), sigma(NavState::kGnssBias + k));
  }
  add("speed_mps", frame.state.v_map.norm());
  add("outage_error_m", frame.outage_error_m);
  add("outage_distance_m", frame.outage_distance_m);
  add("solver_iterations", frame.iterations);
  add("converged", frame.converged ? 1 : 0);
  add("states", frame.states);
}

std::vector<std::string> names_of_columns() {
  std::vector<std::string> names;
  for_each_value(NavFrame{}, {},
                 [&](std::string name, double) { names.push_back(std::move(name)); });
  return names;
}

}  // namespace

NavigationEstimator::NavigationEstimator(const inertial::NavigationOptions& options,
                                         const dataset::RecordingInfo& recording)
    : options_(options),
      recording_(recording.path.string()),
      imu_(imu_of(recording).label),
      gnss_(label_of(recording, SensorKind::kGnss)),
      wheels_(label_of(recording, SensorKind::kWheels)),
      R_body_imu_(imu_of(recording).T_body_sensor.rotation),
      T_nav_body_{Eigen::Matrix3d::Identity(), -imu_of(recording).T_body_sensor.translation},
      p_antenna_told_(mounts_of(recording).antenna_body - T_nav_body_.translation),
      navigation_(fitted(options, recording), mounts_of(recording)) {}

const std::vector<std::string>& NavigationEstimator::columns() const {
  static const std::vector<std::string> kNames = names_of_columns();
  return kNames;
}

bool NavigationEstimator::depends_on(SensorKind kind) const {
  return kind == SensorKind::kImu || (kind == SensorKind::kGnss && options_.gnss.use) ||
         (kind == SensorKind::kWheels && options_.wheels.use);
}

std::vector<PoseFrame> NavigationEstimator::process(const sensors::Measurement& measurement) {
  const auto begin = std::chrono::steady_clock::now();
  std::vector<NavFrame> frames;
  const std::string& label = sensors::sensor_of(measurement);
  if (const auto* imu = std::get_if<sensors::ImuSample>(&measurement); imu && label == imu_) {
    sensors::ImuSample sample = *imu;
    sample.angular_rate = R_body_imu_ * imu->angular_rate;
    sample.specific_force = R_body_imu_ * imu->specific_force;
    imu_readings_.waiting.push_back(imu->stamp);
    frames = navigation_.add(sample);
  } else if (const auto* fix = std::get_if<sensors::GnssFix>(&measurement); fix && label == gnss_) {
    fixes_.waiting.push_back(fix->stamp);
    frames = navigation_.add(*fix);
  } else if (const auto* wheels = std::get_if<sensors::WheelOdometry>(&measurement);
             wheels && label == wheels_) {
    wheel_readings_.waiting.push_back(wheels->stamp);
    frames = navigation_.add(*wheels);
  }
  milliseconds_ +=
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return to_body(frames);
}

std::vector<PoseFrame> NavigationEstimator::finish() {
  std::vector<PoseFrame> frames = to_body(navigation_.finish());
  if (frames_ == 0) {
    throw std::runtime_error(recording_ + ": navigation never began: " + navigation_.start_note());
  }
  return frames;
}

void NavigationEstimator::Readings::finish(geometry::Stamp stamp, std::size_t Readings::*count) {
  for (; !waiting.empty() && waiting.front() <= stamp; waiting.pop_front()) {
    if (count != nullptr) ++(this->*count);
  }
}

/// Readings that led to a frame were used in it, or rejected with it. A state may take pulses of
/// several readings, which are then used together.
void NavigationEstimator::count(const NavFrame& frame) {
  const geometry::Stamp stamp = frame.state.stamp;
  const auto finish = [&](Readings& readings, const Innovation& found) {
    if (found.rows == 0) return;
    readings.finish(stamp, found.is_rejected ? &Readings::rejected : &Readings::used);
  };
  imu_readings_.finish(stamp, frames_ > 0 ? &Readings::used : nullptr);
  if (frames_ == 0) {  // what came before the first state is not in it
    fixes_.finish(geometry::Stamp{stamp.nanoseconds - 1}, nullptr);
    wheel_readings_.finish(geometry::Stamp{stamp.nanoseconds - 1}, nullptr);
  }
  finish(wheel_readings_, frame.standing.rows > 0 ? frame.standing : frame.wheels);
  // A fix is taken alone: those between it and the frame before were not.
  fixes_.finish(geometry::Stamp{stamp.nanoseconds - 1}, nullptr);
  finish(fixes_, frame.gnss);
}

/// How much the path jerks at a fix: the second difference of its places at the fixes less what its
/// own velocities account for, so that a bend that is driven smoothly has none.
std::optional<double> NavigationEstimator::roughness(const NavFrame& frame) {
  constexpr double kLongest_s = 1;
  if (frame.restarted) at_fixes_.clear();
  if (!frame.by_gnss) return std::nullopt;
  at_fixes_.push_back(frame.state);
  if (at_fixes_.size() < 3) return std::nullopt;
  if (at_fixes_.size() > 3) at_fixes_.pop_front();
  const NavState& a = at_fixes_[0];
  const NavState& b = at_fixes_[1];
  const NavState& c = at_fixes_[2];
  const double before_s = geometry::seconds_between(a.stamp, b.stamp);
  const double after_s = geometry::seconds_between(b.stamp, c.stamp);
  if (!(before_s > 0 && after_s > 0) || before_s > kLongest_s || after_s > kLongest_s) {
    return std::nullopt;
  }
  const Eigen::Vector3d change_of_velocity =
      (c.p_map - b.p_map) / after_s - (b.p_map - a.p_map) / before_s;
  return (change_of_velocity - (c.v_map - a.v_map) / 2).norm() * (before_s + after_s) / 2;
}

std::vector<PoseFrame> NavigationEstimator::to_body(const std::vector<NavFrame>& frames) {
  std::vector<PoseFrame> result;
  for (const NavFrame& frame : frames) {
    count(frame);
    ++frames_;
    PoseFrame out;
    out.stamp = frame.state.stamp;
    out.T_map_body = frame.state.T_map_body() * T_nav_body_;
    out.velocity.tail<3>() = frame.state.q_map_body.conjugate() * frame.state.v_map;
    const Beside beside{p_antenna_told_, roughness(frame).value_or(kNotMeasured),
                        options_.window.output == inertial::WindowOutput::kOldest};
    for_each_value(frame, beside, [&](const auto&, double value) { out.record.push_back(value); });
    out.milliseconds = milliseconds_;
    milliseconds_ = 0;
    result.push_back(std::move(out));
  }
  return result;
}

UsedScan NavigationEstimator::used_scan(const sensors::LidarScan&, const PoseFrame&, bool) const {
  return {};
}

std::vector<Decision> NavigationEstimator::decisions() const {
  std::vector<Decision> decisions{{"start", navigation_.start_note()}};
  if (const auto& plane = navigation_.plane()) {
    const auto& origin = plane->origin();
    decisions.push_back(
        {"map origin", fmt::format("{:.8f} deg north, {:.8f} deg east, {:.3f} m; x east, y north",
                                   origin.latitude_deg, origin.longitude_deg, origin.altitude_m)});
    decisions.push_back({"gravity", fmt::format("{:.5f} m/s^2", plane->gravity())});
  }
  for (const inertial::Fact& fact : navigation_.facts()) {
    decisions.push_back({fact.name, fact.value});
  }
  for (const auto& [what, count] : navigation_.events()) {
    decisions.push_back({what, fmt::format("{} times", count)});
  }
  for (const inertial::OutageResult& outage : navigation_.outages()) {
    decisions.push_back(
        {fmt::format("{:.0f} s without GNSS", outage.seconds),
         fmt::format("{:.3f} m off the first fix after it, {:.3f} % of {:.1f} m (own sigma "
                     "{:.3f} m)",
                     outage.error_m,
                     outage.distance_m > 0 ? 100 * outage.error_m / outage.distance_m : 0,
                     outage.distance_m, outage.sigma_m)});
  }
  return decisions;
}

std::vector<SensorUse> NavigationEstimator::sensor_use() const {
  const auto use = [](const std::string& label, SensorKind kind, const Readings& readings) {
    SensorUse sensor{.label = label, .kind = kind};
    sensor.used = readings.used;
    sensor.rejected = readings.rejected;
    return sensor;
  };
  std::vector<SensorUse> uses{use(imu_, SensorKind::kImu, imu_readings_)};
  if (!gnss_.empty()) {
    uses.push_back(use(gnss_, SensorKind::kGnss, fixes_));
    uses.back().is_taken = options_.gnss.use;
    uses.back().reason = options_.gnss.use ? events_about("fix") : "switched off (gnss.use)";
  }
  if (!wheels_.empty()) {
    uses.push_back(use(wheels_, SensorKind::kWheels, wheel_readings_));
    uses.back().is_taken = options_.wheels.use;
    uses.back().reason = options_.wheels.use ? events_about("wheel") : "switched off (wheels.use)";
  }
  return uses;
}

/// What happened to the readings that a word names, "12 times fix withheld on purpose".
std::string NavigationEstimator::events_about(const std::string& word) const {
  std::string text;
  for (const auto& [what, times] : navigation_.events()) {
    if (what.find(word) == std::string::npos) continue;
    text += fmt::format("{}{} times {}", text.empty() ? "" : "; ", times, what);
  }
  return text;
}

std::optional<Eigen::Vector3d> NavigationEstimator::north_map() const {
  if (!navigation_.plane()) return std::nullopt;
  return Eigen::Vector3d::UnitY();  // the map is east, north, up
}

std::vector<optimization::FactorUse> NavigationEstimator::factors() const {
  return inertial::factors_of(options_, !gnss_.empty(), !wheels_.empty());
}

}  // namespace traverse::pipeline
