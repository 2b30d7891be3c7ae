#include "traverse/inertial/navigation.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>

#include <Eigen/Eigenvalues>

#include "traverse/geometry/so3.hpp"

#include "fixed_lag_smoother.hpp"
#include "innovation.hpp"
#include "navigation_start.hpp"
#include "outage_schedule.hpp"
#include "wheel_speed.hpp"

namespace traverse::inertial {

using geometry::seconds_between;
using geometry::Stamp;
using sensors::GnssFix;
using sensors::ImuSample;
using sensors::WheelOdometry;

namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

/// Readings closer than this to a state belong to it.
constexpr double kSameMoment = 1e-4;

template <typename Model>
using Covariance = Eigen::Matrix<double, Model::kSize, Model::kSize>;

bool is_positive_definite(const Eigen::Matrix3d& P) {
  if (!P.allFinite() || (P - P.transpose()).norm() > 1e-6 * P.norm()) return false;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(P, Eigen::EigenvaluesOnly)
             .eigenvalues()
             .minCoeff() > 1e-12;
}

ImuSample interpolated(const ImuSample& before, const ImuSample& after, Stamp stamp) {
  const double span = seconds_between(before.stamp, after.stamp);
  const double share = span > 0 ? seconds_between(before.stamp, stamp) / span : 1;
  ImuSample sample = before;
  sample.stamp = stamp;
  sample.angular_rate += share * (after.angular_rate - before.angular_rate);
  sample.specific_force += share * (after.specific_force - before.specific_force);
  return sample;
}

}  // namespace

class Navigation::Impl {
 public:
  Impl(const NavigationOptions& options, const Mounts& mounts)
      : options_(options),
        mounts_(mounts),
        gravity_(options.gravity),
        start_(std::in_place, options.start, options.wheels, mounts, gravity_),
        wheel_speed_(mounts.encoder, options.wheels.standing_mps),
        outages_(options.outage) {}

  /// After a copy: samples join a pre-integration of its own.
  void own_the_link() {
    if (link_) link_ = std::make_shared<Preintegration>(*link_);
  }

  std::vector<NavFrame> add(const ImuSample& sample) {
    if (!sample.angular_rate.allFinite() || !sample.specific_force.allFinite()) {
      ++events["IMU reading that is not finite"];
      return take_frames();
    }
    if (previous_ && sample.stamp <= previous_->stamp) {
      ++events["IMU reading not later than the one before"];
      return take_frames();
    }
    if (previous_ && seconds_between(previous_->stamp, sample.stamp) > options_.longest_gap_s) {
      start_anew();
    }
    while (!waiting_.empty() && stamp_of(waiting_.front()) <= sample.stamp) {
      const Waiting reading = std::move(waiting_.front());
      waiting_.pop_front();
      if (previous_ && stamp_of(reading) < previous_->stamp) {
        ++events["reading that came late"];
        continue;
      }
      if (previous_) advance(interpolated(*previous_, sample, stamp_of(reading)));
      std::visit([this](const auto& held) { use(held); }, reading);
    }
    advance(sample);
    start_without_fix();
    return take_frames();
  }

  std::vector<NavFrame> add(const GnssFix& fix) {
    const bool is_place = std::isfinite(fix.latitude_deg) && std::isfinite(fix.longitude_deg) &&
                          std::abs(fix.latitude_deg) <= 90;
    if (!is_place) {
      ++events["fix that is no place"];
    } else if (std::isnan(fix.altitude_m)) {
      ++events["fix without altitude"];
    } else {
      waiting_.emplace_back(fix);
    }
    return take_frames();
  }

  std::vector<NavFrame> add(const WheelOdometry& reading) {
    waiting_.emplace_back(reading);
    return take_frames();
  }

  std::vector<NavFrame> finish() {
    if (!waiting_.empty()) events["reading after the last of the IMU"] += waiting_.size();
    waiting_.clear();
    emit();
    return take_frames();
  }

  std::string start_note() const { return has_started() ? note_ : start_->why_not(); }

  std::optional<geodesy::LocalTangentPlane> plane;
  std::map<std::string, std::size_t> events;
  std::vector<OutageResult> outage_results;

 private:
  using Waiting = std::variant<GnssFix, WheelOdometry>;
  static Stamp stamp_of(const Waiting& reading) {
    return std::visit([](const auto& held) { return held.stamp; }, reading);
  }
  bool has_started() const { return smoother_.has_value(); }

  // ---- time

  /// Integrates from the previous IMU reading to `sample`.
  void advance(const ImuSample& sample) {
    if (previous_ && sample.stamp > previous_->stamp) {
      const double seconds = seconds_between(previous_->stamp, sample.stamp);
      if (has_started()) integrate(sample, seconds);
    }
    previous_ = sample;
    if (!has_started()) start_->add(sample);
  }

  void integrate(const ImuSample& sample, double seconds) {
    constexpr double kGap = 0.06;     // s; longer is not a rate that an IMU has
    constexpr double kGapNoise = 30;  // what happened in it is hardly known
    constexpr double kPiece = 0.01;
    const bool is_gap = seconds > kGap;
    if (is_gap) ++events["gap between IMU readings"];
    const Eigen::Vector3d rate = 0.5 * (previous_->angular_rate + sample.angular_rate);
    // The later reading is in axes that have turned: brought back, the mean is the trapezoidal rule
    // on R a, of second order, where the mean of the readings as they are is of first.
    const Eigen::Vector3d turn = (rate - link_->gyro_bias()) * seconds;
    const Eigen::Vector3d force =
        0.5 * (previous_->specific_force + geometry::exp_so3(turn) * sample.specific_force);
    const int pieces = is_gap ? static_cast<int>(std::ceil(seconds / kPiece)) : 1;
    for (int k = 0; k < pieces; ++k) {
      link_->add(rate, force, seconds / pieces, is_gap ? kGapNoise : 1);
    }
    const NavState moved = link_->predict(smoother_->newest(), gravity_map());
    const double forward = (moved.q_map_body.conjugate() * moved.v_map).x();
    // The speed's change within this step alone: solutions in between move the speed itself.
    if (nominal_forward_) wheel_speed_.add_change(sample.stamp, forward - *nominal_forward_);
    nominal_forward_ = forward;
    outages_.add_distance(moved.v_map.norm() * seconds);
  }

  Eigen::Vector3d gravity_map() const { return {0, 0, -gravity_}; }

  void begin_link() {
    const NavState& newest = smoother_->newest();
    link_ =
        std::make_shared<Preintegration>(options_.imu, newest.gyro_bias, newest.accelerometer_bias);
    nominal_forward_ = (newest.q_map_body.conjugate() * newest.v_map).x();
  }

  // ---- beginning

  void start_anew() {
    ++events["IMU gap after which navigation started anew"];
    emit();
    smoother_.reset();
    previous_.reset();
    frame_.reset();
    waiting_.clear();
    start_.emplace(options_.start, options_.wheels, mounts_, gravity_);
  }

  NavState::Tangent smallest_doubt() const {
    NavState::Tangent sigma = NavState::Tangent::Zero();
    sigma.segment<3>(NavState::kGyroBias).setConstant(options_.start.gyro_bias);
    sigma.segment<3>(NavState::kAccelerometerBias).setConstant(options_.start.accelerometer_bias);
    return sigma;
  }

  void begin(const FirstState& first) {
    smoother_.emplace(options_.window, options_.imu, options_.wheels.scale_walk, gravity_map());
    smoother_->start(first.state, first.sigma);
    first_sigma_ = first.sigma.cwiseMax(smallest_doubt());
    note_ = first.note;
    begin_link();
    outages_.start(first.state.stamp);
    frame_ = NavFrame{};
  }

  void start_without_fix() {
    if (has_started() || !previous_) return;
    if (const auto first = start_->without_fix(previous_->stamp)) {
      begin(*first);
      is_georeferenced_ = false;
      solve();
    }
  }

  // ---- readings

  void use(const GnssFix& fix) {
    if (!previous_) {
      ++events["fix before the first IMU reading"];
      return;
    }
    if (!options_.gnss.use) return;
    if (!is_georeferenced_) {
      ++events["fix after dead reckoning had begun"];
      return;
    }
    const bool was_started = has_started();
    if (!plane) set_origin(fix);
    const MapFix map_fix = in_map(fix);
    if (!was_started) {
      const auto first = start_->at_fix(map_fix);
      if (!first) return;
      begin(*first);
    }
    const bool is_out = outages_.is_out(fix.stamp);
    if (is_out) ++events["fix kept back on purpose"];
    // The wheels make states meanwhile, where there are any.
    if (is_out && (wheel_speed_.is_fresh() || is_close_to_newest(fix.stamp))) return;
    make_state(fix.stamp);
    frame_->by_gnss = !is_out;
    if (!is_out) constrain(map_fix);
    if (takes_wheels_too()) constrain_by_wheels();
    solve();
  }

  bool takes_wheels_too() const { return options_.trigger == Trigger::kGnss; }

  void use(const WheelOdometry& reading) {
    if (!wheel_speed_.add(reading)) {
      ++events["wheel reading that tells no speed"];
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
    frame_->by_wheels = true;
    constrain_by_wheels();
    solve();
  }

  void set_origin(const GnssFix& fix) {
    plane.emplace(geodesy::Geodetic{fix.latitude_deg, fix.longitude_deg, fix.altitude_m});
    gravity_ = plane->gravity();
  }

  MapFix in_map(const GnssFix& fix) {
    MapFix result;
    result.stamp = fix.stamp;
    result.p_antenna_map = plane->to_enu({fix.latitude_deg, fix.longitude_deg, fix.altitude_m});
    const GnssOptions& gnss = options_.gnss;
    const double h = gnss.horizontal_m * gnss.horizontal_m;
    result.covariance = Eigen::Vector3d(h, h, gnss.vertical_m * gnss.vertical_m).asDiagonal();
    if (gnss.use_covariance && fix.covariance_enu) {
      if (is_positive_definite(*fix.covariance_enu)) {
        result.covariance = *fix.covariance_enu;
      } else {
        ++events["fix whose covariance is not positive definite"];
      }
    }
    if (gnss.use_heading && fix.heading_deg && std::isfinite(*fix.heading_deg)) {
      result.heading =
          std::remainder((90 - *fix.heading_deg) * kRadiansPerDegree - mounts_.baseline_angle,
                         2 * std::numbers::pi);
    }
    return result;
  }

  // ---- states and their constraints

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
    link_->split_single_sample();
    emit();
    smoother_->append(link_);
    begin_link();
    frame_ = NavFrame{};
    frame_->in_outage = outages_.is_now_out();
  }

  template <typename Model>
  Innovation take(const Model& model, const Covariance<Model>& R, bool gate, double huber = 0) {
    Innovation found = innovation(model, smoother_->newest(), smoother_->covariance(), R);
    if (gate && found.chi2 > chi2_bound(Model::kSize)) {
      found.is_rejected = true;
      return found;
    }
    auto factor =
        std::make_unique<ModelFactor<Model>>(model, square_root_information<Model::kSize>(R));
    factor->huber = huber;
    smoother_->add(std::move(factor));
    return found;
  }

  void constrain(const MapFix& fix) {
    const GnssOptions& gnss = options_.gnss;
    const NavState& predicted = smoother_->newest();
    const Eigen::Vector3d residual =
        gnss_position_residual(fix.p_antenna_map, mounts_.antenna_body, predicted);
    frame_->gnss_residual_enu = residual;
    if (outages_.has_just_ended()) report_outage(residual);

    const bool gate = gnss.gate && rejected_in_a_row_ < gnss.most_rejected;
    if (gnss.gate && !gate) doubt_everything(fix);
    const bool as_pose = gnss.form == GnssForm::kPose && fix.heading.has_value();
    frame_->gnss = as_pose ? take_pose(fix, gate)
                           : take(GnssPositionModel{fix.p_antenna_map, mounts_.antenna_body},
                                  fix.covariance, gate, gnss.huber);
    rejected_in_a_row_ = frame_->gnss.is_rejected ? rejected_in_a_row_ + 1 : 0;
    if (frame_->gnss.is_rejected) ++events["fix rejected by chi-square"];
    if (!as_pose && fix.heading) {
      const double sigma = gnss.heading_deg * kRadiansPerDegree;
      frame_->heading = take(HeadingModel{*fix.heading}, Covariance<HeadingModel>(sigma * sigma),
                             gate, gnss.huber);
      if (frame_->heading.is_rejected) ++events["heading rejected by chi-square"];
    }
  }

  /// Fixes that disagree for so long are right, and the estimate is not: it begins again from here,
  /// keeping what it knows of the biases.
  void doubt_everything(const MapFix& fix) {
    ++events["navigation begun again after too many fixes were rejected"];
    constexpr double kTilt = 0.05;    // rad
    constexpr double kHeading = 0.3;  // rad
    constexpr double kVelocity = 3;   // m/s
    constexpr double kBiasDoubt = 5;  // times the standard deviation that was believed
    NavState state = smoother_->newest();
    NavState::Tangent sigma =
        (kBiasDoubt * smoother_->covariance().diagonal().cwiseSqrt()).cwiseMin(first_sigma_);
    state.p_map = fix.p_antenna_map - state.q_map_body * mounts_.antenna_body;
    sigma.segment<3>(NavState::kRotation) << kTilt, kTilt, kHeading;
    sigma.segment<3>(NavState::kPosition) = 10 * fix.covariance.diagonal().cwiseSqrt();
    sigma.segment<3>(NavState::kVelocity).setConstant(kVelocity);
    smoother_->start(state, sigma);
  }

  /// The book's form: the antenna's place moved to the body with the heading that was measured, and
  /// that heading as a whole rotation.
  Innovation take_pose(const MapFix& fix, bool gate) {
    GnssPoseModel model;
    model.T_map_body_measured.rotation = geometry::exp_so3({0, 0, *fix.heading});
    model.T_map_body_measured.translation =
        fix.p_antenna_map - model.T_map_body_measured.rotation * mounts_.antenna_body;
    const double sigma = options_.gnss.heading_deg * kRadiansPerDegree;
    Covariance<GnssPoseModel> R = Covariance<GnssPoseModel>::Zero();
    R.topLeftCorner<3, 3>() = sigma * sigma * Eigen::Matrix3d::Identity();
    R.bottomRightCorner<3, 3>() = fix.covariance;
    return take(model, R, gate, options_.gnss.huber);
  }

  void constrain_by_wheels() {
    const WheelOptions& wheels = options_.wheels;
    if (!wheels.use) return;
    const NavState& x = smoother_->newest();
    const auto speed = wheel_speed_.take(x.stamp);
    if (!speed) return;
    // Wheels that disagree for long are right: without them nothing bounds the speed.
    constexpr int kMostRejected = 10;
    const bool gate = wheels.gate && wheels_rejected_in_a_row_ < kMostRejected;
    if (wheels.zero_velocity && wheel_speed_.standing_seconds() > wheels.standing_s) {
      Eigen::Matrix<double, 6, 1> sigma;
      constexpr double kStandingRate = 5e-3;  // rad/s; an engine shakes
      sigma << Eigen::Vector3d::Constant(std::max(1e-3, wheels.standing_mps / 2)),
          Eigen::Vector3d::Constant(kStandingRate);
      frame_->standing = take(ZeroVelocityModel{previous_->angular_rate},
                              sigma.cwiseAbs2().asDiagonal().toDenseMatrix(), gate);
      if (frame_->standing.is_rejected) ++events["stand-still rejected by chi-square"];
      count_rejection(frame_->standing);
      return;
    }
    const Eigen::Vector3d sigma(wheels.forward_mps, wheels.sideways_mps, wheels.upwards_mps);
    if (wheels.form == WheelForm::kVelocity) {
      frame_->wheels = take(WheelVelocityModel{*speed, mounts_.wheels, previous_->angular_rate},
                            sigma.cwiseAbs2().asDiagonal().toDenseMatrix(), gate);
    } else {
      const WheelMount& mount = mounts_.wheels;
      const Eigen::Vector3d rate = previous_->angular_rate - x.gyro_bias;
      const Eigen::Vector3d v_body =
          mount.R_wheels_body.transpose() * Eigen::Vector3d(*speed, 0, 0) -
          rate.cross(mount.p_body);
      const Eigen::Vector3d v_map = x.q_map_body * v_body;
      const double forward = wheels.forward_mps * wheels.forward_mps;
      frame_->wheels = take(WorldVelocityModel{v_map},
                            Eigen::Matrix3d(forward * Eigen::Matrix3d::Identity()), gate);
    }
    if (frame_->wheels.is_rejected) ++events["wheel reading rejected by chi-square"];
    count_rejection(frame_->wheels);
  }

  void count_rejection(const Innovation& found) {
    wheels_rejected_in_a_row_ = found.is_rejected ? wheels_rejected_in_a_row_ + 1 : 0;
  }

  void report_outage(const Eigen::Vector3d& residual) {
    const Eigen::Matrix2d P =
        smoother_->covariance().block<2, 2>(NavState::kPosition, NavState::kPosition);
    const OutageResult result =
        outages_.take_result(residual.head<2>().norm(), std::sqrt(P.trace()));
    outage_results.push_back(result);
    frame_->outage_error_m = result.error_m;
    frame_->outage_distance_m = result.distance_m;
  }

  void solve() {
    const FixedLagSmoother::Solution solution = smoother_->solve();
    frame_->state = smoother_->newest();
    frame_->covariance = smoother_->covariance();
    frame_->iterations += solution.iterations;
    frame_->states = static_cast<int>(smoother_->size());
    frame_->inertial = {solution.inertial_chi2, smoother_->size() > 1 ? 9 : 0, false};
    begin_link();
  }

  // ---- frames

  /// The newest frame is complete when a later state begins.
  void emit() {
    if (frame_ && frame_->states > 0) done_.push_back(*frame_);
    frame_.reset();
  }

  std::vector<NavFrame> take_frames() { return std::exchange(done_, {}); }

  NavigationOptions options_;
  Mounts mounts_;
  double gravity_;
  std::optional<NavigationStart> start_;
  std::string note_;
  NavState::Tangent first_sigma_;  ///< and that of a start in motion, whichever is larger
  bool is_georeferenced_ = true;
  std::optional<FixedLagSmoother> smoother_;
  std::shared_ptr<Preintegration> link_;
  std::optional<double> nominal_forward_;
  std::optional<ImuSample> previous_;
  std::deque<Waiting> waiting_;
  WheelSpeed wheel_speed_;
  OutageSchedule outages_;
  int rejected_in_a_row_ = 0;
  int wheels_rejected_in_a_row_ = 0;
  std::optional<NavFrame> frame_;
  std::vector<NavFrame> done_;
};

Navigation::Navigation(const NavigationOptions& options, const Mounts& mounts)
    : impl_(std::make_unique<Impl>(options, mounts)) {}
Navigation::Navigation(const Navigation& other) : impl_(std::make_unique<Impl>(*other.impl_)) {
  impl_->own_the_link();
}
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
