#include "traverse/fusion/inertial_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "traverse/inertial/factor_kinds.hpp"
#include "traverse/lidar/deskew.hpp"
#include "traverse/parallel/workers.hpp"
#include "traverse/sensors/sweep_timing.hpp"
#include "traverse/voxel_map/row_factor_kinds.hpp"
#include "traverse/voxel_map/used_points.hpp"

#include "fused_scans.hpp"
#include "imu_readings.hpp"
#include "inertial_start.hpp"

namespace traverse::fusion {

using geometry::Stamp;
using voxel_map::SweepSample;

InertialOdometryOptions::InertialOdometryOptions() {
  // A state a scan, of which the matches tell the pose each time: wider than data sheets say,
  // because scale and axes of the IMU err too, and gravity's direction is not estimated further.
  imu.gyro_density = 5e-4;
  imu.accelerometer_density = 2e-2;
  imu.gyro_bias_walk = 1e-5;
  imu.accelerometer_bias_walk = 1e-3;
  window.states = 5;
  window.iterations = 2;
}

void bind(config::Binder& b, StartOptions& o) {
  using config::Range;
  b.group("stand_still", "detection of stand-still",
          [&](config::Binder& g) { bind(g, o.stand_still); });
  b.number("moving_s", o.moving_s, Range::between(0.5, 60),
           "poses by the lidar alone that a start in motion needs, s");
  b.number("gravity", o.gravity, Range::positive(), "m/s^2");
  b.number("accelerometer_bias", o.accelerometer_bias, Range::positive(),
           "standard deviation at the start, m/s^2");
  b.number("most_gyro_bias", o.most_gyro_bias, Range::positive(),
           "largest bias of the gyro that is believed, rad/s");
  b.number("most_gravity_error", o.most_gravity_error, Range::positive(),
           "largest error of the length of gravity that a start in motion finds, m/s^2");
  b.number("most_accelerometer_bias", o.most_accelerometer_bias, Range::positive(),
           "largest bias of the accelerometer that is believed, m/s^2");
  b.number(
      "most_disagreement", o.most_disagreement, Range::positive(),
      "largest chi-square by degrees of freedom, over forty scans, at which the IMU is believed");
  b.number("longest_gap_s", o.longest_gap_s, Range::positive(),
           "gap between IMU readings that is bridged; beyond it, constant velocity");
}

void bind(config::Binder& b, InertialOdometryOptions& o) {
  using config::Range;
  bind(b, o.lidar);
  b.group("fusion", "IMU, wheels and lidar in one estimate", [&](config::Binder& g) {
    g.number("information_share", o.information_share, Range::between(1e-6, 1),
             "share of the matches' information that is new in each scan");
    g.number("min_plane_width_m", o.min_plane_width_m, Range::non_negative(),
             "with an IMU: least width of a plane across, as map.planes.min_width_m");
    g.group("imu", "noise of the IMU", [&](config::Binder& i) { bind(i, o.imu); });
    g.group("window", "the smoother's states", [&](config::Binder& w) {
      w.integer("states", o.window.states, Range::between(2, 1000), "at most");
      bind(w, o.window);
    });
    g.group("wheels", "wheel odometry", [&](config::Binder& w) { bind(w, o.wheels); });
    g.group("start", "how fusion begins", [&](config::Binder& s) { bind(s, o.start); });
  });
}

class InertialOdometry::Impl {
 public:
  Impl(const InertialOdometryOptions& options, const sensors::LidarProfile& profile,
       bool motion_compensated)
      : options_(completed(options)),
        profile_(profile),
        motion_compensated_(motion_compensated),
        deskew_note_(lidar::deskew_note(options.lidar.deskew, profile, motion_compensated)),
        workers_(std::make_shared<parallel::Workers>(options.threads)),
        alone_(options_.lidar, profile, motion_compensated) {}

  void mount(const sensors::Rig& rig, const sensors::MountedSensor& lidar) {
    const sensors::MountedSensor* imu = rig.first(sensors::SensorKind::kImu);
    has_imu_ = imu != nullptr;
    start_note_ = has_imu_ ? "not begun: too few scans to begin with"
                           : "no IMU in this recording: as the lidar alone";
    if (imu == nullptr) return;
    options_.lidar.map.planes.fit.min_width_m = options_.min_plane_width_m;
    alone_ = voxel_map::VoxelMapOdometry(options_.lidar, profile_, motion_compensated_);
    const geometry::Pose3 T_lidar_body = lidar.T_body_sensor.inverse();
    p_lidar_imu_ = T_lidar_body * imu->T_body_sensor.translation;
    mounts_.p_lidar_body = -p_lidar_imu_;
    const sensors::MountedSensor* wheels = rig.first(sensors::SensorKind::kWheels);
    if (wheels == nullptr || !options_.wheels.use) return;
    has_wheels_ = true;
    mounts_.wheels.emplace();
    mounts_.wheels->encoder = wheels->encoder;
    const geometry::Pose3 T_lidar_wheels = T_lidar_body * wheels->T_body_sensor;
    mounts_.wheels->mount.R_wheels_body = T_lidar_wheels.rotation.transpose();
    mounts_.wheels->mount.p_body = T_lidar_wheels.translation - p_lidar_imu_;
  }

  void observe(const sensors::ImuSample& sample) {
    if (has_imu_) imu_.add(sample);
  }

  void observe(const sensors::WheelOdometry& reading) {
    if (!has_wheels_) return;
    if (!wheels_.empty() && reading.stamp <= wheels_.back().stamp) return;
    wheels_.push_back(reading);
  }

  std::vector<lidar::Frame> process(const sensors::LidarScan& scan) {
    pending_.push_back(alone_.sampler().sample(scan, *workers_));
    return drain(false);
  }

  /// The scans whose sweeps the IMU has covered, or for which it is not waited any longer.
  std::vector<lidar::Frame> drain(bool is_last) {
    std::vector<lidar::Frame> frames;
    const auto move_to = [&](std::vector<lidar::Frame> found) {
      std::move(found.begin(), found.end(), std::back_inserter(frames));
    };
    while (!pending_.empty() && (is_last || pending_.size() > 1 || is_covered(pending_.front()))) {
      const SweepSample sample = std::move(pending_.front());
      pending_.pop_front();
      move_to(take(sample));
    }
    if (is_last && !fused_) move_to(told(alone_.finish()));
    return frames;
  }

  lidar::CorrectedScan used_scan(const sensors::LidarScan& scan, const geometry::Twist& velocity,
                                 bool with_classes) const {
    const FusedScans::Swept* swept = fused_ ? fused_->sweep_of(scan.stamp) : nullptr;
    const sensors::PointClock clock(scan, profile_);
    if (swept == nullptr || deskew_note_ != "on" || !clock.knows()) {
      return alone_.used_scan(scan, velocity, with_classes);
    }
    lidar::CorrectedScan used = alone_.used_scan(scan, geometry::Twist::Zero(), with_classes);
    std::vector<float> times;
    times.reserve(used.source.size());
    for (const std::uint32_t i : used.source) times.push_back(clock(i));
    swept->path.apply(times, swept->stamp_s, used);
    return used;
  }

  const std::string& deskew_note() const { return deskew_note_; }
  bool is_fused() const { return fused_.has_value(); }
  bool has_imu() const { return has_imu_; }
  bool has_wheels() const { return has_wheels_; }

  std::vector<lidar::Note> notes() const {
    std::vector<lidar::Note> notes{{"fusion", start_note_, is_contradicted_, true}};
    if (imu_.left_out() > 0) {
      notes.push_back({"IMU readings left out (not finite, or not later than the one before)",
                       std::to_string(imu_.left_out())});
    }
    if (!fused_) return notes;
    for (const auto* events : {&fused_->events(), &fused_->chain().events()}) {
      for (const auto& [what, times] : *events) notes.push_back({what, std::to_string(times)});
    }
    return notes;
  }

  const std::vector<std::string>& further_columns() const {
    static const std::vector<std::string> kNone;
    return has_imu_ ? kColumns : kNone;
  }

  std::size_t bytes() const {
    return imu_.bytes() + alone_.bytes() + (fused_ ? fused_->bytes() : 0);
  }

  std::vector<Eigen::Vector3d> local_map() const {
    const voxel_map::VoxelMap& map = fused_ ? fused_->map() : alone_.map();
    std::vector<Eigen::Vector3d> points = map.planes().points();
    const std::vector<Eigen::Vector3d> on_lines = map.lines().points();
    points.insert(points.end(), on_lines.begin(), on_lines.end());
    return points;
  }

  std::vector<lidar::MatchedPoint> matches() const {
    return fused_ ? fused_->matches() : alone_.matches();
  }

 private:
  static InertialOdometryOptions completed(InertialOdometryOptions options) {
    options.lidar.threads = options.threads;
    options.lidar.covariance = true;
    return options;
  }

  bool was_given_up() const { return fused_from_ > 0 && !fused_; }

  bool is_covered(const SweepSample& sample) const {
    if (!has_imu_ || was_given_up()) return true;
    const double last_s = voxel_map::time_span(sample).second;
    return imu_.reach(geometry::shifted(sample.stamp, sample.middle_s + last_s));
  }

  std::vector<lidar::Frame> take(const SweepSample& sample) {
    const Stamp middle = geometry::shifted(sample.stamp, sample.middle_s);
    if (!fused_) {
      const bool looks_for_start = has_imu_ && !was_given_up();
      if (looks_for_start) waiting_.push_back({sample.stamp, sample.middle_s});
      std::vector<lidar::Frame> frames = alone_.process(sample);
      if (looks_for_start) look_for_start(frames, sample);
      return told(std::move(frames));
    }
    const auto later = std::upper_bound(
        wheels_.begin(), wheels_.end(), middle,
        [](Stamp stamp, const sensors::WheelOdometry& reading) { return stamp < reading.stamp; });
    const std::vector<sensors::WheelOdometry> wheels(wheels_.begin(), later);
    wheels_.erase(wheels_.begin(), later);
    lidar::Frame frame = fused_->add(sample, imu_, wheels);
    forget_before(fused_->chain().newest().stamp);
    std::vector<lidar::Frame> frames = told({std::move(frame)});
    const std::string contradiction = contradiction_found();
    if (!contradiction.empty()) go_on_alone(frames.back(), sample.middle_s, contradiction);
    return frames;
  }

  /// What makes the IMU unbelievable, in words; empty if nothing does.
  std::string contradiction_found() const {
    const inertial::NavState& x = fused_->chain().newest();
    const char* cause = "axes (vehicle.imu.roll_pitch_yaw_deg), unit or clock of the IMU are wrong";
    if (x.accelerometer_bias.norm() > options_.start.most_accelerometer_bias) {
      return fmt::format("the accelerometer's bias would be {:.2f} m/s^2: {}",
                         x.accelerometer_bias.norm(), cause);
    }
    if (x.gyro_bias.norm() > options_.start.most_gyro_bias) {
      return fmt::format("the gyro's bias would be {:.2f} rad/s: {}", x.gyro_bias.norm(), cause);
    }
    if (fused_->disagreement() > options_.start.most_disagreement) {
      return fmt::format("its predictions are off by {:.0f} times what they say: {}",
                         std::sqrt(fused_->disagreement()), cause);
    }
    return "";
  }

  void go_on_alone(const lidar::Frame& last, double middle_s, const std::string& why) {
    is_contradicted_ = true;
    start_note_ = fmt::format("given up after frame {} (begun with frame {}), {}", last.index,
                              fused_from_, why);
    alone_.go_on(fused_->map(),
                 {last.index + 1, last.stamp, middle_s, fused_->lidar_in_the_middle(),
                  last.velocity, fused_->uncertainty()});
    fused_.reset();
  }

  /// Whether what the lidar alone has found is enough to begin with.
  /// \param sample  the last of them
  void look_for_start(const std::vector<lidar::Frame>& frames, const SweepSample& sample) {
    constexpr double kMostRemembered_s = 10;
    for (const lidar::Frame& frame : frames) {
      const Waiting scan = waiting_.front();
      waiting_.pop_front();
      if (frame.index > 0 && !frame.health.registered) {
        sightings_.clear();
        continue;
      }
      sightings_.push_back({geometry::shifted(scan.stamp, scan.middle_s),
                            (frame.T_map_lidar * geometry::exp_se3(scan.middle_s * frame.velocity))
                                .orthonormalised()});
    }
    if (frames.empty() || sightings_.empty()) return;
    const Stamp now = sightings_.back().stamp;
    const double most_s =
        std::min(kMostRemembered_s,
                 std::max(options_.start.moving_s, options_.start.stand_still.seconds) + 0.5);
    while (geometry::seconds_between(sightings_.front().stamp, now) > most_s) {
      sightings_.erase(sightings_.begin());
    }
    const StartVerdict verdict = find_start(sightings_, imu_, p_lidar_imu_, options_);
    if (verdict.first) {
      is_contradicted_ = false;
      fused_from_ = frames.back().index + 1;
      start_note_ = fmt::format("from frame {} on, {}", fused_from_, verdict.first->how);
      fused_.emplace(options_, mounts_, *verdict.first, first_map(*verdict.first, sample),
                     alone_.uncertainty(), deskew_note_ == "on", profile_.sweep_s, fused_from_,
                     workers_);
      return;
    }
    is_contradicted_ = verdict.is_contradiction;
    start_note_ = "not begun: " + verdict.why_not;
    forget_before(geometry::shifted(sightings_.front().stamp, -1));
  }

  /// Of a lidar that stood still every scan shows the same rings; one of them is all that is known.
  voxel_map::VoxelMap first_map(const FirstState& first, const SweepSample& sample) {
    if (!first.was_standing) return alone_.map();
    voxel_map::VoxelMap map(options_.lidar.map);
    map.insert(sample, sightings_.back().T_map_lidar, geometry::Twist::Zero(), *workers_);
    return map;
  }

  void forget_before(Stamp stamp) {
    constexpr double kKept_s = 1;  // a sweep begins before its middle
    const Stamp oldest = geometry::shifted(stamp, -kKept_s);
    imu_.forget_before(oldest);
    while (!fused_ && !wheels_.empty() && wheels_.front().stamp < oldest) wheels_.pop_front();
  }

  /// Each with what further_columns() names.
  std::vector<lidar::Frame> told(std::vector<lidar::Frame> frames) const {
    if (!has_imu_) return frames;
    for (lidar::Frame& frame : frames) {
      const bool is_fused = fused_ && frame.index >= fused_from_;
      frame.further.assign(kColumns.size(), 0.0);
      if (!is_fused) continue;
      const inertial::NavState& x = fused_->chain().newest();
      frame.further[0] = 1;
      for (Eigen::Index k = 0; k < 3; ++k) {
        const auto n = static_cast<std::size_t>(k);
        frame.further[1 + n] = x.gyro_bias[k];
        frame.further[4 + n] = x.accelerometer_bias[k];
      }
      frame.further[7] = x.wheel_scale;
      frame.further[8] = fused_->innovation();
      const auto sigma = [&](int part) {
        return std::sqrt(fused_->chain().covariance()(part, part));
      };
      for (int k = 0; k < 3; ++k) {
        const auto n = static_cast<std::size_t>(k);
        frame.further[9 + n] = sigma(inertial::NavState::kGyroBias + k);
        frame.further[12 + n] = sigma(inertial::NavState::kAccelerometerBias + k);
      }
      frame.further[15] = sigma(inertial::NavState::kWheelScale);
    }
    return frames;
  }

  struct Waiting {
    Stamp stamp;
    double middle_s = 0;
  };

  /// As those of navigation, which charts and tables know.
  inline static const std::vector<std::string> kColumns{"fused",
                                                        "gyro_bias_x_rad_s",
                                                        "gyro_bias_y_rad_s",
                                                        "gyro_bias_z_rad_s",
                                                        "accelerometer_bias_x_m_s2",
                                                        "accelerometer_bias_y_m_s2",
                                                        "accelerometer_bias_z_m_s2",
                                                        "wheel_scale",
                                                        "imu_innovation",
                                                        "gyro_bias_x_sigma",
                                                        "gyro_bias_y_sigma",
                                                        "gyro_bias_z_sigma",
                                                        "accelerometer_bias_x_sigma",
                                                        "accelerometer_bias_y_sigma",
                                                        "accelerometer_bias_z_sigma",
                                                        "wheel_scale_sigma"};

  InertialOdometryOptions options_;
  sensors::LidarProfile profile_;
  bool motion_compensated_ = false;
  std::string deskew_note_;
  std::shared_ptr<parallel::Workers> workers_;  // copies share the threads, which hold no state
  bool has_imu_ = false;
  bool has_wheels_ = false;
  Eigen::Vector3d p_lidar_imu_ = Eigen::Vector3d::Zero();  // the IMU from the lidar
  FusedMounts mounts_;
  std::deque<sensors::WheelOdometry> wheels_;
  std::deque<SweepSample> pending_;  // until the IMU has covered them
  std::deque<Waiting> waiting_;      // for their frames by the lidar alone
  std::vector<Sighting> sightings_;
  ImuReadings imu_;
  voxel_map::VoxelMapOdometry alone_;  // until fusion begins
  std::optional<FusedScans> fused_;
  std::size_t fused_from_ = 0;  // the first frame that the IMU has to do with
  std::string start_note_;
  bool is_contradicted_ = false;  // the IMU, by the lidar
};

InertialOdometry::InertialOdometry(const InertialOdometryOptions& options,
                                   const sensors::LidarProfile& profile, bool motion_compensated)
    : impl_(std::make_unique<Impl>(options, profile, motion_compensated)) {}
InertialOdometry::InertialOdometry(const InertialOdometry& other)
    : impl_(std::make_unique<Impl>(*other.impl_)) {}
InertialOdometry::~InertialOdometry() = default;

void InertialOdometry::mount(const sensors::Rig& rig, const sensors::MountedSensor& lidar) {
  impl_->mount(rig, lidar);
}
void InertialOdometry::observe(const sensors::ImuSample& sample_lidar) {
  impl_->observe(sample_lidar);
}
void InertialOdometry::observe_wheels(const sensors::WheelOdometry& reading) {
  impl_->observe(reading);
}
bool InertialOdometry::uses_imu() const { return impl_->is_fused(); }
bool InertialOdometry::uses_wheels() const { return impl_->has_wheels() && impl_->is_fused(); }

std::vector<lidar::Frame> InertialOdometry::process(const sensors::LidarScan& scan) {
  return impl_->process(scan);
}
std::vector<lidar::Frame> InertialOdometry::finish() { return impl_->drain(true); }
const std::string& InertialOdometry::deskew_note() const { return impl_->deskew_note(); }
const std::vector<std::string>& InertialOdometry::further_columns() const {
  return impl_->further_columns();
}
std::vector<lidar::Note> InertialOdometry::notes() const { return impl_->notes(); }

lidar::CorrectedScan InertialOdometry::used_scan(const sensors::LidarScan& scan,
                                                 const geometry::Twist& velocity,
                                                 bool with_classes) const {
  return impl_->used_scan(scan, velocity, with_classes);
}

std::size_t InertialOdometry::bytes() const { return impl_->bytes(); }
std::vector<Eigen::Vector3d> InertialOdometry::local_map() const { return impl_->local_map(); }
std::vector<lidar::MatchedPoint> InertialOdometry::matches() const { return impl_->matches(); }

std::vector<optimization::FactorUse> InertialOdometry::factors() const {
  std::vector<optimization::FactorUse> uses = voxel_map::row_factors();
  if (!impl_->has_imu()) return uses;
  for (optimization::FactorUse& use : inertial::factors_of_chain(impl_->has_wheels())) {
    uses.push_back(std::move(use));
  }
  return uses;
}

}  // namespace traverse::fusion
