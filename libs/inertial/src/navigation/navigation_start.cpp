#include "navigation/navigation_start.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"

#include "factors/innovation.hpp"

namespace traverse::inertial {

namespace {

constexpr double kUnknownHeading = 1e-3;  // a frame of its own has its heading by definition

}  // namespace

NavigationStart::NavigationStart(const NavigationOptions& options, const Mounts& mounts,
                                 double gravity)
    : options_(options.start),
      gnss_(options.gnss),
      wheels_(options.wheels),
      mounts_(mounts),
      gravity_(gravity),
      finder_(options.start.stand_still, gravity),
      gyro_density_(options.imu.gyro_density),
      most_tilt_sigma_(options.start.tilt_deg * geometry::kDegree) {}

void NavigationStart::add(const sensors::ImuSample& sample) {
  if (!first_sample_) first_sample_ = sample.stamp;
  finder_.add(sample);
  if (!recent_.empty()) {
    const double seconds = geometry::seconds_between(recent_.back().stamp, sample.stamp);
    const Eigen::Vector3d bias =
        last_still_ ? last_still_->gyro_bias : Eigen::Vector3d(Eigen::Vector3d::Zero());
    const Eigen::Vector3d turn =
        seconds * (0.5 * (recent_.back().angular_rate + sample.angular_rate) - bias);
    const Eigen::Vector3d up_body =
        last_still_ ? Eigen::Vector3d(q_level_body_.conjugate() * Eigen::Vector3d::UnitZ())
                    : sample.specific_force.normalized();
    yaw_ += up_body.dot(turn);
    q_level_body_ = (q_level_body_ * geometry::exp_quaternion(turn)).normalized();
    since_still_s_ += seconds;
  }
  if (auto still = finder_.find()) {
    last_still_ = still;
    q_level_body_ = Eigen::Quaterniond(still->R_level_body);
    since_still_s_ = 0;
  }
  recent_.push_back(sample);
  while (geometry::seconds_between(recent_.front().stamp, sample.stamp) > options_.course_s) {
    recent_.pop_front();
  }
}

void NavigationStart::add_wheels(geometry::Stamp stamp, double forward_mps) {
  forward_mps_ = forward_mps;
  finder_.add_wheels(stamp, std::abs(forward_mps) > wheels_.standing_mps);
}

/// Level and biases, at rest in the origin; heading and motion are for the caller to add.
FirstState NavigationStart::begin(geometry::Stamp stamp) {
  constexpr double kLeastGyroBias = 1e-5;  // of a perfect gyro
  FirstState first;
  first.state.stamp = stamp;
  first.sigma.setOnes();
  first.state.gnss_latency = gnss_.latency_s;
  first.sigma[NavState::kWheelScale] = wheels_.scale;
  first.sigma.segment<2>(NavState::kWheelTurn).setConstant(wheels_.turn_deg * geometry::kDegree);
  first.sigma[NavState::kGnssLatency] = gnss_.latency_sigma_s;
  first.sigma.segment<3>(NavState::kGnssBias) << gnss_.bias_horizontal_m, gnss_.bias_horizontal_m,
      gnss_.bias_vertical_m;
  first.sigma.segment<3>(NavState::kAccelerometerBias).setConstant(options_.accelerometer_bias);
  if (last_still_ && is_level_by_still()) {
    // The gyro's heading is none: only what it makes of the vertical.
    first.state.q_map_body =
        Eigen::Quaterniond(levelled(q_level_body_.conjugate() * Eigen::Vector3d::UnitZ()));
    first.state.gyro_bias = last_still_->gyro_bias;
    first.state.accelerometer_bias = last_still_->accelerometer_bias;
    first.sigma.head<2>().setConstant(still_tilt_sigma());
    first.sigma.segment<3>(NavState::kGyroBias)
        .setConstant(last_still_->gyro_bias_sigma + kLeastGyroBias);
    first.note = "level and biases from a stand-still";
    return first;
  }
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const auto& sample : recent_) force += sample.specific_force;
  if (!recent_.empty()) first.state.q_map_body = Eigen::Quaterniond(levelled(force));
  first.sigma.head<2>().setConstant(options_.tilt_deg * geometry::kDegree);
  first.sigma.segment<3>(NavState::kGyroBias).setConstant(options_.gyro_bias);
  first.note =
      "level from the mean specific force, biases zero: no stand-still (" + finder_.why_not() + ")";
  return first;
}

/// Of roll and pitch, by the last stand-still and the gyro since.
double NavigationStart::still_tilt_sigma() const {
  constexpr double kStillTilt = 0.3 * geometry::kDegree;
  if (!last_still_) return std::numeric_limits<double>::infinity();
  return std::hypot(std::max(kStillTilt, options_.accelerometer_bias / gravity_),
                    gyro_bias_sigma() * since_still_s_, gyro_density_ * std::sqrt(since_still_s_));
}

double NavigationStart::gyro_bias_sigma() const {
  return last_still_ ? last_still_->gyro_bias_sigma : options_.gyro_bias;
}

std::optional<FirstState> NavigationStart::at_fix(const MapFix& fix) {
  has_fix_ = true;
  fixes_.push_back({fix, yaw_});
  while (geometry::seconds_between(fixes_.front().fix.stamp, fix.stamp) > options_.course_s) {
    fixes_.pop_front();
  }
  if (recent_.size() < 2) return std::nullopt;
  // So long nobody knows whether it stands, and a stand-still tells more than any motion.
  const double known_s = geometry::seconds_between(*first_sample_, fix.stamp);
  if (known_s < options_.stand_still.seconds) return std::nullopt;
  std::optional<Heading> heading = antennas_heading();
  if (!heading) heading = course();
  if (!heading) return std::nullopt;

  FirstState first = begin(fix.stamp);
  first.note += "; heading from " + heading->note;
  // Over the last part of the way, so that neither turns nor a start from rest disturb much.
  const MapFix& before = fixes_[fixes_.size() > 3 ? fixes_.size() - 3 : 0].fix;
  const double part_s = geometry::seconds_between(before.stamp, fix.stamp);
  const bool is_still = finder_.find().has_value();
  const bool by_fixes = part_s > 0 && !is_still;
  first.state.q_map_body =
      (geometry::exp_quaternion({0, 0, heading->rad}) * first.state.q_map_body).normalized();
  first.state.p_map = fix.p_antenna_map - first.state.q_map_body * mounts_.antenna_body;
  first.state.v_map = by_fixes
                          ? Eigen::Vector3d((fix.p_antenna_map - before.p_antenna_map) / part_s)
                          : Eigen::Vector3d(Eigen::Vector3d::Zero());
  first.sigma[2] = heading->sigma;
  const Eigen::Vector3d fix_sigma = fix.covariance.diagonal().cwiseSqrt();
  first.sigma.segment<3>(NavState::kPosition) =
      10 * fix_sigma + Eigen::Vector3d::Constant(0.1) +  // the fix itself is a factor
      first.sigma.segment<3>(NavState::kGnssBias);
  first.sigma.segment<3>(NavState::kVelocity) =
      Eigen::Vector3d::Constant(is_still ? 0.05 : 1) +
      (by_fixes ? Eigen::Vector3d(2 * fix_sigma / part_s) : Eigen::Vector3d::Zero());
  return first;
}

/// The newest heading, if most of those before it say the same, turned by the gyro: one alone may
/// be of a carrier's cycle that was counted wrong.
std::optional<NavigationStart::Heading> NavigationStart::antennas_heading() const {
  const TurnedFix& newest = fixes_.back();
  if (!newest.fix.heading) return std::nullopt;
  const double sigma = newest.fix.heading_sigma;
  std::size_t others = 0;
  std::size_t agreeing = 0;
  for (std::size_t k = 0; k + 1 < fixes_.size(); ++k) {
    const TurnedFix& other = fixes_[k];
    if (!other.fix.heading) continue;
    const double seconds = geometry::seconds_between(other.fix.stamp, newest.fix.stamp);
    const double now = *other.fix.heading + newest.yaw - other.yaw;
    const double difference = std::remainder(now - *newest.fix.heading, 2 * std::numbers::pi);
    const double variance = 2 * sigma * sigma + std::pow(gyro_bias_sigma() * seconds, 2);
    ++others;
    agreeing += difference * difference <= chi2_bound(1) * variance ? 1 : 0;
  }
  if (agreeing == 0 || 2 * agreeing < others) return std::nullopt;
  return Heading{*newest.fix.heading, std::max(sigma, options_.heading_deg * geometry::kDegree),
                 "two antennas"};
}

/// The surest of the courses from an earlier fix to the newest.
std::optional<NavigationStart::Heading> NavigationStart::course() const {
  std::optional<Heading> best;
  if (finder_.find()) return best;  // what fixes of a vehicle that stands are apart is their noise
  for (std::size_t k = 0; k + 1 < fixes_.size(); ++k) {
    const auto found = course_since(k);
    if (found && (!best || found->sigma < best->sigma)) best = found;
  }
  return best;
}

/// What the fixes since that one may have stepped by, as a receiver does that goes over from one
/// set of ambiguities to another, whatever deviation it tells: nothing where they lie on a parabola
/// over time as they say, else a carrier's wavelength.
double NavigationStart::step_m(std::size_t first) const {
  constexpr double kWavelength_m = 0.19;  // of L1
  constexpr std::size_t kLeast = 6;       // twice what the parabola takes
  constexpr double kOnePercent = 2.326;   // deviations of a normal distribution
  constexpr double kUnseen = 3;           // deviations of a fix, near an end of the parabola
  const std::size_t count = fixes_.size() - first;
  if (count < kLeast) return kWavelength_m;
  const auto seconds = [&](std::size_t k) {
    return geometry::seconds_between(fixes_.back().fix.stamp, fixes_[k].fix.stamp);
  };
  const double span = std::abs(seconds(first));
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> sum = Eigen::Matrix<double, 3, 2>::Zero();
  const auto powers = [&](std::size_t k) {
    const double t = seconds(k) / span;
    return Eigen::Vector3d(1, t, t * t);
  };
  for (std::size_t k = first; k < fixes_.size(); ++k) {
    const Eigen::Vector3d basis = powers(k);
    information += basis * basis.transpose();
    sum += basis * fixes_[k].fix.p_antenna_map.head<2>().transpose();
  }
  const Eigen::Matrix<double, 3, 2> parabola = information.ldlt().solve(sum);
  double chi2 = 0;
  for (std::size_t k = first; k < fixes_.size(); ++k) {
    const MapFix& fix = fixes_[k].fix;
    const Eigen::Vector2d off = fix.p_antenna_map.head<2>() - parabola.transpose() * powers(k);
    chi2 += off.dot(fix.covariance.topLeftCorner<2, 2>().ldlt().solve(off));
  }
  // Wilson and Hilferty's bound: the cube root of chi-square over its rows is nearly normal.
  const double rows = 2 * static_cast<double>(count) - 6;
  const double part = 2 / (9 * rows);
  const double bound = rows * std::pow(1 - part + kOnePercent * std::sqrt(part), 3);
  const double sigma =
      std::sqrt(fixes_.back().fix.covariance.topLeftCorner<2, 2>().diagonal().maxCoeff());
  return chi2 <= bound ? std::min(kUnseen * sigma, kWavelength_m) : kWavelength_m;
}

/// The heading of a vehicle whose rear axle slips to no side, from the way of its antenna and the
/// gyro's turns. The axle goes the way s along the mean u of its headings; the antenna, a ahead of
/// it, swings by w besides: |s u + w| is the way between the fixes, and the angle between the two
/// the heading. The deviation is that of the fixes, of a step that they may hold, the gyro's bias,
/// and a fifth of the turn, for the speed was not the same all along.
std::optional<NavigationStart::Heading> NavigationStart::course_since(std::size_t first) const {
  constexpr double kShareOfTurn = 0.2;
  // rad; a way of five deviations: noise makes one in a hundred thousand pairs of fixes
  constexpr double kWorst = 0.2;
  const TurnedFix& from = fixes_[first];
  const TurnedFix& to = fixes_.back();
  const Eigen::Vector2d way = (to.fix.p_antenna_map - from.fix.p_antenna_map).head<2>();
  const double distance = way.norm();
  const double seconds = geometry::seconds_between(from.fix.stamp, to.fix.stamp);
  const double fix_variance = std::max(to.fix.covariance(0, 0) + from.fix.covariance(0, 0),
                                       to.fix.covariance(1, 1) + from.fix.covariance(1, 1)) +
                              std::pow(std::max(to.fix.step_m, step_m(first)), 2);
  const double turn = to.yaw - from.yaw;
  const double sigma = std::hypot(std::sqrt(fix_variance) / distance,
                                  gyro_bias_sigma() * seconds / 2, kShareOfTurn * turn);
  const double asked = options_.heading_deg * geometry::kDegree;
  const bool is_exact = to.fix.is_sigma_known && sigma <= asked;
  const bool is_far = distance >= options_.course_m &&
                      (sigma <= kWorst || (!to.fix.is_sigma_known && std::abs(turn) <= kWorst));
  if (!(seconds > 0) || !(is_exact || is_far)) return std::nullopt;

  Eigen::Vector2d u = Eigen::Vector2d::Zero();
  for (std::size_t k = first; k < fixes_.size(); ++k) {
    const double weight = k == first || k + 1 == fixes_.size() ? 0.5 : 1;
    const Eigen::Rotation2Dd ahead(fixes_[k].yaw - to.yaw);
    u += weight * (ahead * Eigen::Vector2d::UnitX());
  }
  u /= static_cast<double>(fixes_.size() - 1 - first);
  const Eigen::Vector2d arm = (mounts_.antenna_body - mounts_.wheels.p_body).head<2>();
  const Eigen::Vector2d w = arm - Eigen::Rotation2Dd(-turn) * arm;
  const double half = u.dot(w);
  const double root = half * half - u.squaredNorm() * (w.squaredNorm() - distance * distance);
  if (!(root > 0)) return std::nullopt;
  const bool is_backwards = forward_mps_ && *forward_mps_ < 0;
  const double s = (-half + (is_backwards ? -1 : 1) * std::sqrt(root)) / u.squaredNorm();
  const Eigen::Vector2d told = s * u + w;
  const double heading = std::atan2(way.y(), way.x()) - std::atan2(told.y(), told.x());
  return Heading{std::remainder(heading, 2 * std::numbers::pi), std::clamp(sigma, asked, kWorst),
                 fmt::format("{:.1f} m between fixes", distance)};
}

std::optional<FirstState> NavigationStart::without_fix(geometry::Stamp now) {
  if (has_fix_ || !first_sample_ || !finder_.find()) return std::nullopt;
  if (geometry::seconds_between(*first_sample_, now) < options_.gnss_wait_s) return std::nullopt;
  FirstState first = begin(now);
  first.sigma[2] = kUnknownHeading;
  first.sigma.segment<3>(NavState::kPosition).setConstant(kUnknownHeading);
  first.sigma.segment<3>(NavState::kVelocity).setConstant(0.01);
  first.note += "; no fix: dead reckoning in a frame of its own";
  return first;
}

std::string NavigationStart::why_not() const {
  if (!first_sample_) return "no IMU reading came";
  if (has_fix_) {
    return fmt::format(
        "no heading: no two headings of the fixes agree, and their course was never exact to {} "
        "degrees, nor did they move {} m, within {} s",
        options_.heading_deg, options_.course_m, options_.course_s);
  }
  return fmt::format("no fix came, and dead reckoning needs a stand-still to begin with ({})",
                     finder_.why_not());
}

}  // namespace traverse::inertial
