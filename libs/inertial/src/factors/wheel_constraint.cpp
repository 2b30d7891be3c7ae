#include "factors/wheel_constraint.hpp"

#include <algorithm>

#include "factors/gated_factor.hpp"
#include "residuals/zero_velocity.hpp"

namespace traverse::inertial {

void WheelConstraint::constrain(FixedLagSmoother& smoother, WheelSpeed& wheel_speed,
                                const Eigen::Vector3d& angular_rate, const Trust& trust,
                                NavFrame& frame, Events& events) {
  const auto speed = wheel_speed.take(smoother.newest().stamp);
  if (!speed) return;
  const bool in_wheels = options_.form == WheelForm::kVelocity || !trust.has_heading;
  const WheelVelocityResidual in_own_axes{*speed, mount_, angular_rate};
  if (options_.gate) {
    jumps_.add(smoother.newest().stamp, in_own_axes(smoother.newest())[0]);
    if (is_estimate_astray(trust)) begin_again(smoother, in_own_axes, frame, events);
  }
  const NavState& x = smoother.newest();
  Innovation found;
  if (options_.zero_velocity && wheel_speed.standing_seconds() > options_.standing_s) {
    constexpr double kStandingRate = 5e-3;  // rad/s; an engine shakes
    Eigen::Matrix<double, 6, 1> sigma;
    sigma << Eigen::Vector3d::Constant(std::max(1e-3, options_.standing_mps / 2)),
        Eigen::Vector3d::Constant(kStandingRate);
    found = constrain_newest(smoother, ZeroVelocityResidual{angular_rate},
                             sigma.cwiseAbs2().asDiagonal().toDenseMatrix(), options_.gate);
    frame.standing = found;
    if (found.is_rejected) ++events["stand-still rejected by chi-square"];
  } else {
    found = in_wheels ? constrain_newest(smoother, in_own_axes,
                                         velocity_covariance(WheelForm::kVelocity), options_.gate)
                      : constrain_newest(smoother, in_map(x, *speed, angular_rate),
                                         velocity_covariance(options_.form), options_.gate);
    frame.wheels = found;
    if (found.is_rejected) ++events["wheel reading rejected by chi-square"];
  }
  if (!found.is_rejected) {
    disagree_since_.reset();
    jumps_.agree();
  } else if (jumps_.has_jumped()) {
    disagree_since_
        .reset();  // what the estimate has to do with it shows when they have jumped back
  } else if (!disagree_since_) {
    disagree_since_ = smoother.newest().stamp;
  }
}

/// Wheels and IMU are two, and without fixes nobody decides between them but what they are: an
/// estimate drifts, and wheels jump. With fixes that agree with the estimate wheels are wrong for
/// as long as they like.
bool WheelConstraint::is_estimate_astray(const Trust& trust) const {
  constexpr double kLong = 1;  // s; a pothole or a kerb is over
  if (!disagree_since_ || trust.has_fixes || jumps_.has_jumped()) return false;
  return geometry::seconds_between(*disagree_since_, trust.now) > kLong;
}

/// From the wheels' velocity; what led to the one that was wrong is doubted with it.
void WheelConstraint::begin_again(FixedLagSmoother& smoother, const WheelVelocityResidual& told,
                                  NavFrame& frame, Events& events) {
  constexpr double kDoubt = 5;  // times the standard deviation that was believed
  NavState state = smoother.newest();
  const Residual<3> r = told(state);
  NavState::Tangent sigma = smoother.covariance().diagonal().cwiseSqrt();
  sigma.segment<3>(NavState::kRotation) *= kDoubt;
  sigma.segment<6>(NavState::kGyroBias) *= kDoubt;
  sigma.segment<3>(NavState::kVelocity).setConstant(r.norm());
  state.v_map -= state.q_map_body * (told.mount.R_wheels_body.transpose() * r);
  smoother.start(state, sigma);
  ++events["navigation begun again after wheels disagreed that had not jumped"];
  frame.restarted = true;
  disagree_since_.reset();
  jumps_.agree();
}

void WheelConstraint::constrain_last(FixedLagSmoother& smoother, const WheelSpeed& wheel_speed,
                                     const Eigen::Vector3d& angular_rate,
                                     const Trust& trust) const {
  const NavState& x = smoother.state(smoother.size() - 2);
  const auto speed = wheel_speed.taken_at(x.stamp);
  if (!speed) return;
  smoother.add_to_last(
      options_.form == WheelForm::kVelocity || !trust.has_heading
          ? make_factor(WheelVelocityResidual{*speed, mount_, angular_rate},
                        velocity_covariance(WheelForm::kVelocity))
          : make_factor(in_map(x, *speed, angular_rate), velocity_covariance(options_.form)));
}

/// The book's form: turned into the map once, with the attitude of the moment.
WorldVelocityResidual WheelConstraint::in_map(const NavState& x, double forward_mps,
                                              const Eigen::Vector3d& angular_rate) const {
  const Eigen::Vector3d v_body =
      mount_.R_wheels_body.transpose() * Eigen::Vector3d(forward_mps, 0, 0) -
      (angular_rate - x.gyro_bias).cross(mount_.p_body);
  return {x.q_map_body * v_body};
}

/// In the wheels' axes; the book knows one deviation for all directions.
Eigen::Matrix3d WheelConstraint::velocity_covariance(WheelForm form) const {
  if (form == WheelForm::kWorldVelocity) {
    return options_.forward_mps * options_.forward_mps * Eigen::Matrix3d::Identity();
  }
  const Eigen::Vector3d sigma(options_.forward_mps, options_.sideways_mps, options_.upwards_mps);
  return sigma.cwiseAbs2().asDiagonal();
}

}  // namespace traverse::inertial
