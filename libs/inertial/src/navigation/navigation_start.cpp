#include "navigation/navigation_start.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"

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
      finder_(options.start.stand_still, gravity) {}

void NavigationStart::add(const sensors::ImuSample& sample) {
  if (!first_sample_) first_sample_ = sample.stamp;
  finder_.add(sample);
  if (auto still = finder_.find()) last_still_ = still;
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
  constexpr double kStillTilt = 0.3 * geometry::kDegree;
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
  if (last_still_) {
    first.state.q_map_body = Eigen::Quaterniond(last_still_->R_level_body);
    first.state.gyro_bias = last_still_->gyro_bias;
    first.state.accelerometer_bias = last_still_->accelerometer_bias;
    first.sigma.head<2>().setConstant(std::max(kStillTilt, options_.accelerometer_bias / gravity_));
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

std::optional<FirstState> NavigationStart::at_fix(const MapFix& fix) {
  has_fix_ = true;
  fixes_.push_back(fix);
  while (geometry::seconds_between(fixes_.front().stamp, fix.stamp) > options_.course_s) {
    fixes_.pop_front();
  }
  if (recent_.size() < 2) return std::nullopt;
  const double seconds = geometry::seconds_between(fixes_.front().stamp, fix.stamp);
  const Eigen::Vector3d way = fix.p_antenna_map - fixes_.front().p_antenna_map;
  const double distance = way.head<2>().norm();
  const bool is_still = finder_.find().has_value();
  const bool has_course = seconds > 0 && distance >= options_.course_m;
  if (!has_course && !(fix.heading && is_still)) return std::nullopt;

  FirstState first = begin(fix.stamp);
  double heading = 0;
  double heading_sigma = options_.heading_deg * geometry::kDegree;
  // Over the last part of the way, so that neither turns nor a start from rest disturb much.
  const MapFix& before = fixes_[fixes_.size() > 3 ? fixes_.size() - 3 : 0];
  const double part_s = geometry::seconds_between(before.stamp, fix.stamp);
  const Eigen::Vector3d velocity =
      is_still || !(part_s > 0)
          ? Eigen::Vector3d::Zero()
          : Eigen::Vector3d((fix.p_antenna_map - before.p_antenna_map) / part_s);
  if (fix.heading) {
    heading = *fix.heading;
    first.note += "; heading from two antennas";
  } else {
    heading = std::atan2(way.y(), way.x()) + (forward_mps_ < 0 ? std::numbers::pi : 0);
    first.note += fmt::format("; heading from {:.1f} m between fixes", distance);
    // The turn within the way is not known.
    heading_sigma = std::max(heading_sigma, 0.05);
  }
  first.state.q_map_body =
      (geometry::exp_quaternion({0, 0, heading}) * first.state.q_map_body).normalized();
  first.state.p_map = fix.p_antenna_map - first.state.q_map_body * mounts_.antenna_body;
  first.state.v_map = velocity;
  first.sigma[2] = heading_sigma;
  const Eigen::Vector3d fix_sigma = fix.covariance.diagonal().cwiseSqrt();
  first.sigma.segment<3>(NavState::kPosition) =
      10 * fix_sigma + Eigen::Vector3d::Constant(0.1) +  // the fix itself is a factor
      first.sigma.segment<3>(NavState::kGnssBias);
  first.sigma.segment<3>(NavState::kVelocity) =
      Eigen::Vector3d::Constant(is_still ? 0.05 : 1) +
      (part_s > 0 && !is_still ? Eigen::Vector3d(2 * fix_sigma / part_s) : Eigen::Vector3d::Zero());
  return first;
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
        "no heading: the fixes tell none at a stand-still, and never moved {} m within {} s",
        options_.course_m, options_.course_s);
  }
  return fmt::format("no fix came, and dead reckoning needs a stand-still to begin with ({})",
                     finder_.why_not());
}

}  // namespace traverse::inertial
