#include "traverse/inertial/navigation.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "traverse/geometry/angle.hpp"

#include "factors/gnss_constraint.hpp"
#include "factors/imu_link.hpp"
#include "factors/wheel_constraint.hpp"
#include "navigation/first_fixes.hpp"
#include "navigation/fix_scatter.hpp"
#include "navigation/frame_queue.hpp"
#include "navigation/heading_scatter.hpp"
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
    imu_.observe(sample);
    while (!waiting_.empty() && stamp_of(waiting_.front()) <= sample.stamp) {
      const Waiting reading = std::move(waiting_.front());
      waiting_.pop_front();
      if (last && stamp_of(reading) < last->stamp) {
        ++events["reading that came late"];
        continue;
      }
      if (last) advance(interpolated(*last, sample, stamp_of(reading)));
      try {
        std::visit([this](const auto& held) { use(held); }, reading);
      } catch (const NotSolvable&) {
        carry_on(stamp_of(reading));
      }
    }
    if (!first_imu_) first_imu_ = sample.stamp;
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

  std::string start_note() const {
    if (!begun_) return start_->why_not();
    const double late_s = seconds_between(*first_imu_, *begun_);
    const double all_s = imu_.last() ? seconds_between(*first_imu_, imu_.last()->stamp) : 0;
    if (!(all_s > late_s)) return note_;
    return fmt::format("{}; {:.1f} s after the first IMU reading, {:.1f} % of the recording", note_,
                       late_s, 100 * late_s / all_s);
  }

  std::vector<Fact> facts() const {
    std::vector<Fact> facts;
    const bool is_stated = options_.gnss.horizontal_m > 0 && options_.gnss.vertical_m > 0;
    const auto found = scatter_.sigma();
    if (without_covariance_ > 0 && !is_stated) {
      facts.push_back(
          {"sigma of fixes",
           found
               ? fmt::format("{:.3f} m horizontally, {:.3f} m vertically: what the last {} "
                             "scatter by against the IMU; {} tell none, and gnss.horizontal_m "
                             "and gnss.vertical_m state none",
                             found->horizontal_m, found->vertical_m, scatter_.fixes(),
                             without_covariance_)
               : fmt::format("1 m horizontally, 2 m vertically, as of one receiver alone: {} tell "
                             "none, and they are too few to scatter",
                             without_covariance_)});
    }
    const double told = options_.gnss.heading_deg * geometry::kDegree;
    const double by_scatter = heading_scatter_.sigma(told);
    if (by_scatter > told) {
      facts.push_back({"sigma of headings",
                       fmt::format("{:.2f} deg: what they scatter by against the gyro, more than "
                                   "gnss.heading_deg says",
                                   by_scatter / geometry::kDegree)});
    }
    if (const auto shaken = imu_.shaking()) {
      facts.push_back(
          {"noise of the IMU",
           fmt::format("at most {:.2g} rad/s/sqrt(Hz) and {:.2g} m/s^2/sqrt(Hz), where it shakes: "
                       "what its readings scatter by, more than imu.gyro_density and "
                       "imu.accelerometer_density say (imu.shaking)",
                       shaken->gyro, shaken->accelerometer)});
    }
    if (failed_at_) {
      facts.push_back(
          {"solver", fmt::format("first failed {:.3f} s after the first IMU reading: the states "
                                 "could not be solved for; what was estimated is kept, and "
                                 "navigation went on from the newest state",
                                 seconds_between(*first_imu_, *failed_at_))});
    }
    return facts;
  }

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
      scatter_.add_motion(step.seconds, step.velocity_change_map);
      outages_.add_distance(step.way_m);
    }
    heading_scatter_.add(sample);
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
    scatter_.forget_path();
    heading_scatter_.forget_turn();
    waiting_.clear();
    start_.emplace(options_, mounts_, gravity_);
  }

  /// After a solution that failed: what is done stays, and the newest state is the first of a new
  /// chain, with the doubt of a first one.
  void carry_on(Stamp stamp) {
    ++events["solution that failed, after which navigation went on from the newest state"];
    if (!failed_at_) failed_at_ = stamp;
    const NavState state = smoother_->newest();
    if (!state.p_map.allFinite() || !state.v_map.allFinite() ||
        !state.q_map_body.coeffs().allFinite()) {
      start_anew();
      return;
    }
    smoother_->start(state, first_sigma_);
    frames_.end(*smoother_);
    frames_.begin(1);
    frames_.newest().restarted = true;
    imu_.begin(state);
    frames_.take(smoother_->solve(), *smoother_);
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
    if (!begun_) {
      begun_ = first.state.stamp;
      note_ = first.note;
    }
    imu_.begin(first.state);
    scatter_.forget_path();
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
    if (!plane) {
      const auto origin = first_fixes_.add(fix, events);
      if (!origin) return;
      set_origin(*origin);
      if (origin->stamp < fix.stamp) start_->at_fix(mapped(*origin));
    }
    MapFix map_fix = mapped(fix);
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
    if (is_paired(options_) && is_close_to_newest(fix.stamp)) {
      ++events["fix within 10 ms of a state"];
      return;
    }
    make_state(fix.stamp);
    frames_.newest().by_gnss = !is_out;
    if (!is_out) {
      frames_.newest().p_antenna_fix_map = map_fix.p_antenna_map;
      constrain_by(map_fix);
    }
    if (options_.trigger == Trigger::kGnss) constrain_by_wheels();
    solve();
  }

  void use(const WheelOdometry& reading) {
    if (!wheel_speed_.add(reading)) {
      ++events[reading.ticks && !mounts_.encoder
                   ? "wheel reading of pulses whose length is not known "
                     "(vehicle.wheels.left_m_per_pulse, right_m_per_pulse)"
                   : "wheel reading without a speed"];
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
    // What the newest state does not believe says nothing of the one before; and that is gone where
    // the estimate began again.
    const NavFrame& frame = frames_.newest();
    const bool is_believed = frame.wheels.rows > 0 && !frame.wheels.is_rejected;
    if (is_paired(options_) && last_was_by_gnss_ && is_believed && smoother_->size() > 1) {
      by_wheels_.constrain_last(*smoother_, wheel_speed_, last_rate_, trust());
    }
    solve();
  }

  MapFix mapped(const GnssFix& fix) {
    MapFix map_fix = in_map(fix, *plane, options_.gnss, mounts_.baseline_angle, scatter_, events);
    const Eigen::Vector3d arm_map = has_started()
                                        ? Eigen::Vector3d(imu_.attitude() * mounts_.antenna_body)
                                        : Eigen::Vector3d::Zero();
    if (!fix.covariance_enu || !options_.gnss.use_covariance) ++without_covariance_;
    scatter_.add(fix.stamp, map_fix.p_antenna_map, arm_map);
    if (map_fix.heading) heading_scatter_.add(fix.stamp, *map_fix.heading);
    map_fix.heading_sigma = heading_scatter_.sigma(options_.gnss.heading_deg * geometry::kDegree);
    if (is_paired(options_)) map_fix.covariance *= kPairedVariance;
    return map_fix;
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
    if (!frames_.newest().gnss.is_rejected) believed_fix_ = fix.stamp;
    if (ends_outage) report_outage(std::sqrt(P.trace()));
    const bool is_rejected = frames_.newest().gnss.is_rejected;
    if (is_paired(options_) && !last_was_by_gnss_ && !is_rejected) constrain_last_by(fix);
    if (is_rejected) {
      last_fix_.reset();
    } else {
      last_fix_ = fix;
    }
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
    by_wheels_.constrain(*smoother_, wheel_speed_, imu_.last()->angular_rate, trust(),
                         frames_.newest(), events);
  }

  WheelConstraint::Trust trust() const {
    const Stamp now = smoother_->newest().stamp;
    const bool has_fixes =
        believed_fix_ && seconds_between(*believed_fix_, now) <= options_.gnss.longest_rejection_s;
    return {now, has_fixes, by_gnss_.has_heading(now)};
  }

  void report_outage(double sigma_m) {
    const OutageResult result =
        outages_.take_result(frames_.newest().gnss_residual_enu.head<2>().norm(), sigma_m);
    outage_results.push_back(result);
    frames_.newest().outage_error_m = result.error_m;
    frames_.newest().outage_distance_m = result.distance_m;
  }

  void solve() {
    NavFrame& frame = frames_.newest();
    if (smoother_->size() > 1 && frame.inertial.rows == 0) {  // what comes later has less to say
      frame.inertial = smoother_->innovation_of_newest();
    }
    const Eigen::Vector3d p_predicted = smoother_->newest().p_map;
    const FixedLagSmoother::Solution solution = smoother_->solve();
    if (!frame.restarted) frame.correction_map += smoother_->newest().p_map - p_predicted;
    frames_.take(solution, *smoother_);
    imu_.begin(smoother_->newest());
  }

  NavigationOptions options_;
  Mounts mounts_;
  double gravity_;
  std::optional<NavigationStart> start_;
  std::string note_;
  std::optional<Stamp> first_imu_, begun_, failed_at_;
  std::size_t without_covariance_ = 0;  ///< fixes
  NavState::Tangent first_sigma_;       ///< and that of a start in motion, whichever is larger
  bool is_georeferenced_ = true;
  std::optional<FixedLagSmoother> smoother_;
  ImuLink imu_;
  std::deque<Waiting> waiting_;
  WheelSpeed wheel_speed_;
  GnssConstraint by_gnss_;
  WheelConstraint by_wheels_;
  OutageSchedule outages_;
  std::optional<MapFix> last_fix_;
  std::optional<Stamp> believed_fix_;
  FixScatter scatter_;
  HeadingScatter heading_scatter_;
  FirstFixes first_fixes_;
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
std::vector<Fact> Navigation::facts() const { return impl_->facts(); }
const std::vector<OutageResult>& Navigation::outages() const { return impl_->outage_results; }

}  // namespace traverse::inertial
