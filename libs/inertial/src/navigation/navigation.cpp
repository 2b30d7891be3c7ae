#include "traverse/inertial/navigation.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>
#include <variant>

#include "factors/gnss_constraint.hpp"
#include "factors/imu_link.hpp"
#include "factors/wheel_constraint.hpp"
#include "navigation/frame_queue.hpp"
#include "navigation/map_fix.hpp"
#include "navigation/navigation_start.hpp"
#include "navigation/outage_schedule.hpp"
#include "navigation/wheel_speed.hpp"
#include "smoother/fixed_lag_smoother.hpp"
#include "smoother/pairing.hpp"

namespace traverse::inertial {

using geometry::seconds_between;
using geometry::Stamp;
using sensors::GnssFix;
using sensors::ImuSample;
using sensors::WheelOdometry;

class Navigation::Impl {
 public:
  Impl(const NavigationOptions& options, const Mounts& mounts)
      : options_(options),
        mounts_(mounts),
        gravity_(options.gravity),
        start_(std::in_place, options, mounts, gravity_),
        imu_(options.imu),
        wheel_speed_(mounts.encoder, options.wheels.standing_mps),
        by_gnss_(options.gnss, mounts.antenna_body),
        by_wheels_(weighed(options), mounts.wheels),
        outages_(options.outage),
        frames_(options.window.output) {}

  std::vector<NavFrame> add(const ImuSample& sample) {
    if (!sample.angular_rate.allFinite() || !sample.specific_force.allFinite()) {
      ++events["IMU reading that is not finite"];
      return frames_.take_done();
    }
    const auto& last = imu_.last();
    if (last && sample.stamp <= last->stamp) {
      ++events["IMU reading not later than the one before"];
      return frames_.take_done();
    }
    if (last && seconds_between(last->stamp, sample.stamp) > options_.longest_gap_s) start_anew();
    while (!waiting_.empty() && stamp_of(waiting_.front()) <= sample.stamp) {
      const Waiting reading = std::move(waiting_.front());
      waiting_.pop_front();
      if (last && stamp_of(reading) < last->stamp) {
        ++events["reading that came late"];
        continue;
      }
      if (last) advance(interpolated(*last, sample, stamp_of(reading)));
      std::visit([this](const auto& held) { use(held); }, reading);
    }
    advance(sample);
    start_without_fix();
    return frames_.take_done();
  }

  std::vector<NavFrame> add(const GnssFix& fix) {
    if (is_place(fix, events)) waiting_.emplace_back(fix);
    return frames_.take_done();
  }

  std::vector<NavFrame> add(const WheelOdometry& reading) {
    waiting_.emplace_back(reading);
    return frames_.take_done();
  }

  std::vector<NavFrame> finish() {
    if (!waiting_.empty()) events["reading after the last of the IMU"] += waiting_.size();
    waiting_.clear();
    end_frames();
    return frames_.take_done();
  }

  std::string start_note() const { return has_started() ? note_ : start_->why_not(); }

  std::optional<geodesy::LocalTangentPlane> plane;
  Events events;
  std::vector<OutageResult> outage_results;

 private:
  using Waiting = std::variant<GnssFix, WheelOdometry>;
  static Stamp stamp_of(const Waiting& reading) {
    return std::visit([](const auto& held) { return held.stamp; }, reading);
  }
  bool has_started() const { return smoother_.has_value(); }
  Eigen::Vector3d gravity_map() const { return {0, 0, -gravity_}; }

  // ---- time

  /// Integrates from the last IMU reading to `sample`.
  void advance(const ImuSample& sample) {
    const auto& last = imu_.last();
    if (has_started() && last && sample.stamp > last->stamp) {
      const ImuLink::Step step = imu_.add(sample, smoother_->newest(), gravity_map());
      if (step.is_gap) ++events["gap between IMU readings"];
      wheel_speed_.add_change(sample.stamp, step.speed_change_mps);
      outages_.add_distance(step.way_m);
    }
    imu_.set_last(sample);
    if (!has_started()) start_->add(sample);
  }

  void end_frames() {
    if (has_started()) frames_.end(*smoother_);
  }

  // ---- beginning

  void start_anew() {
    ++events["IMU gap after which navigation started anew"];
    starts_anew_ = starts_anew_ || has_started();
    end_frames();
    smoother_.reset();
    imu_.set_last(std::nullopt);
    last_fix_.reset();
    waiting_.clear();
    start_.emplace(options_, mounts_, gravity_);
  }

  NavState::Tangent smallest_doubt() const {
    NavState::Tangent sigma = NavState::Tangent::Zero();
    sigma.segment<3>(NavState::kGyroBias).setConstant(options_.start.gyro_bias);
    sigma.segment<3>(NavState::kAccelerometerBias).setConstant(options_.start.accelerometer_bias);
    return sigma;
  }

  void begin(const FirstState& first) {
    smoother_.emplace(options_.window, options_.imu, calibration_walk(options_), gravity_map());
    smoother_->start(first.state, first.sigma);
    first_sigma_ = first.sigma.cwiseMax(smallest_doubt());
    note_ = first.note;
    imu_.begin(first.state);
    outages_.start(first.state.stamp);
    frames_.begin(1);
    frames_.newest().restarted = std::exchange(starts_anew_, false);
  }

  void start_without_fix() {
    if (has_started() || !imu_.last()) return;
    if (const auto first = start_->without_fix(imu_.last()->stamp)) {
      begin(*first);
      is_georeferenced_ = false;
      solve();
    }
  }

  // ---- readings

  void use(const GnssFix& fix) {
    if (!imu_.last()) {
      ++events["fix before the first IMU reading"];
      return;
    }
    if (!options_.gnss.use) return;
    if (!is_georeferenced_) {
      ++events["fix after dead reckoning had begun"];
      return;
    }
    if (!plane) set_origin(fix);
    MapFix map_fix = in_map(fix, *plane, options_.gnss, mounts_.baseline_angle, events);
    if (is_pairing_alike(options_)) map_fix.covariance *= kAlikeVariance;
    if (!has_started()) {
      const auto first = start_->at_fix(map_fix);
      if (!first) return;
      begin(*first);
    }
    const bool is_out = outages_.is_out(fix.stamp);
    if (is_out) ++events["fix withheld on purpose"];
    // The wheels make states meanwhile, where there are any.
    const bool by_wheels = options_.wheels.use && wheel_speed_.is_fresh();
    if (is_out && (by_wheels || is_close_to_newest(fix.stamp))) return;
    if (is_pairing_alike(options_) && is_close_to_newest(fix.stamp)) {
      ++events["fix within 10 ms of a state"];
      return;
    }
    make_state(fix.stamp);
    frames_.newest().by_gnss = !is_out;
    if (!is_out) constrain_by(map_fix);
    if (options_.trigger == Trigger::kGnss) constrain_by_wheels();
    solve();
  }

  void use(const WheelOdometry& reading) {
    if (!wheel_speed_.add(reading)) {
      ++events["wheel reading without a speed"];
      return;
    }
    if (!has_started()) {
      start_->add_wheels(reading.stamp, wheel_speed_.last());
      return;
    }
    if (!options_.wheels.use) return;
    const bool is_due =
        options_.trigger == Trigger::kGnssAndWheels ||
        seconds_between(smoother_->newest().stamp, reading.stamp) > options_.longest_step_s;
    if (!is_due || is_close_to_newest(reading.stamp)) return;
    make_state(reading.stamp);
    frames_.newest().by_wheels = true;
    constrain_by_wheels();
    if (is_pairing_alike(options_) && last_was_by_gnss_) {
      by_wheels_.constrain_last(*smoother_, wheel_speed_, last_rate_);
    }
    solve();
  }

  void set_origin(const GnssFix& fix) {
    plane.emplace(geodesy::Geodetic{fix.latitude_deg, fix.longitude_deg, fix.altitude_m});
    gravity_ = plane->gravity();
  }

  // ---- states and their constraints

  /// Readings closer than this to a state belong to it.
  static constexpr double kSameMoment = 1e-4;

  /// Whether a state at `stamp` would hardly differ from the newest; readings of wheels wait then.
  bool is_close_to_newest(Stamp stamp) const {
    constexpr double kClose = 0.01;
    const double seconds = seconds_between(smoother_->newest().stamp, stamp);
    return seconds > kSameMoment && seconds < kClose;
  }

  /// The state at `stamp`: the newest, if it is of this moment, or one more.
  void make_state(Stamp stamp) {
    const bool is_there = std::abs(seconds_between(smoother_->newest().stamp, stamp)) < kSameMoment;
    if (is_there) return;
    last_was_by_gnss_ = frames_.newest().by_gnss;
    last_rate_ = state_rate_;
    frames_.before_append(*smoother_);
    smoother_->append(imu_.take());
    imu_.begin(smoother_->newest());
    state_rate_ = imu_.last()->angular_rate;
    frames_.begin(smoother_->size());
    frames_.newest().in_outage = outages_.is_now_out();
  }

  void constrain_by(const MapFix& fix) {
    const NavState& x = smoother_->newest();
    const BodyMotion motion{imu_.last()->angular_rate, imu_.acceleration(x, gravity_map())};
    const bool ends_outage = outages_.has_just_ended();
    const Eigen::Matrix2d P =
        smoother_->covariance().block<2, 2>(NavState::kPosition, NavState::kPosition);
    by_gnss_.constrain(*smoother_, fix, motion, first_sigma_, frames_.newest(), events);
    if (ends_outage) report_outage(std::sqrt(P.trace()));
    if (is_pairing_alike(options_) && !last_was_by_gnss_) constrain_last_by(fix);
    last_fix_ = fix;
  }

  /// The state before, which wheels made, by the line between the last two fixes.
  void constrain_last_by(const MapFix& fix) {
    constexpr double kFar = 0.5;  // s
    const bool is_usable =
        last_fix_ && smoother_->size() > 1 && seconds_between(last_fix_->stamp, fix.stamp) < kFar;
    if (!is_usable) return;
    const Stamp stamp = smoother_->state(smoother_->size() - 2).stamp;
    if (stamp > last_fix_->stamp) {
      by_gnss_.constrain_last(*smoother_, interpolated(*last_fix_, fix, stamp));
    }
  }

  void constrain_by_wheels() {
    if (!options_.wheels.use) return;
    by_wheels_.constrain(*smoother_, wheel_speed_, imu_.last()->angular_rate, frames_.newest(),
                         events);
  }

  void report_outage(double sigma_m) {
    const OutageResult result =
        outages_.take_result(frames_.newest().gnss_residual_enu.head<2>().norm(), sigma_m);
    outage_results.push_back(result);
    frames_.newest().outage_error_m = result.error_m;
    frames_.newest().outage_distance_m = result.distance_m;
  }

  void solve() {
    frames_.take(smoother_->solve(), *smoother_);
    imu_.begin(smoother_->newest());
  }

  NavigationOptions options_;
  Mounts mounts_;
  double gravity_;
  std::optional<NavigationStart> start_;
  std::string note_;
  NavState::Tangent first_sigma_;  ///< and that of a start in motion, whichever is larger
  bool is_georeferenced_ = true;
  std::optional<FixedLagSmoother> smoother_;
  ImuLink imu_;
  std::deque<Waiting> waiting_;
  WheelSpeed wheel_speed_;
  GnssConstraint by_gnss_;
  WheelConstraint by_wheels_;
  OutageSchedule outages_;
  std::optional<MapFix> last_fix_;
  bool last_was_by_gnss_ = false;                         ///< what made the state before the newest
  Eigen::Vector3d state_rate_ = Eigen::Vector3d::Zero();  ///< at the newest state
  Eigen::Vector3d last_rate_ = Eigen::Vector3d::Zero();   ///< at the one before
  FrameQueue frames_;
  bool starts_anew_ = false;  ///< the next state is the first after a time without any
};

Navigation::Navigation(const NavigationOptions& options, const Mounts& mounts)
    : impl_(std::make_unique<Impl>(options, mounts)) {}
Navigation::Navigation(const Navigation& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
Navigation::~Navigation() = default;

std::vector<NavFrame> Navigation::add(const ImuSample& sample) { return impl_->add(sample); }
std::vector<NavFrame> Navigation::add(const GnssFix& fix) { return impl_->add(fix); }
std::vector<NavFrame> Navigation::add(const WheelOdometry& reading) { return impl_->add(reading); }
std::vector<NavFrame> Navigation::finish() { return impl_->finish(); }
std::string Navigation::start_note() const { return impl_->start_note(); }
const std::optional<geodesy::LocalTangentPlane>& Navigation::plane() const { return impl_->plane; }
const std::map<std::string, std::size_t>& Navigation::events() const { return impl_->events; }
const std::vector<OutageResult>& Navigation::outages() const { return impl_->outage_results; }

}  // namespace traverse::inertial
