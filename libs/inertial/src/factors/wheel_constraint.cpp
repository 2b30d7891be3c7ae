#include "factors/wheel_constraint.hpp"

#include <algorithm>

#include "factors/gated_factor.hpp"

namespace traverse::inertial {

void WheelConstraint::constrain(FixedLagSmoother& smoother, WheelSpeed& wheel_speed,
                                const Eigen::Vector3d& angular_rate, NavFrame& frame,
                                Events& events) {
  const NavState& x = smoother.newest();
  const auto speed = wheel_speed.take(x.stamp);
  if (!speed) return;
  // Wheels that disagree for long are right: without them nothing bounds the speed.
  constexpr int kMostRejected = 10;
  const bool gate = options_.gate && rejected_in_a_row_ < kMostRejected;
  Innovation found;
  if (options_.zero_velocity && wheel_speed.standing_seconds() > options_.standing_s) {
    constexpr double kStandingRate = 5e-3;  // rad/s; an engine shakes
    Eigen::Matrix<double, 6, 1> sigma;
    sigma << Eigen::Vector3d::Constant(std::max(1e-3, options_.standing_mps / 2)),
        Eigen::Vector3d::Constant(kStandingRate);
    found = constrain_newest(smoother, ZeroVelocityModel{angular_rate},
                             sigma.cwiseAbs2().asDiagonal().toDenseMatrix(), gate);
    frame.standing = found;
    if (found.is_rejected) ++events["stand-still rejected by chi-square"];
  } else {
    found = options_.form == WheelForm::kVelocity
                ? constrain_newest(smoother, WheelVelocityModel{*speed, mount_, angular_rate},
                                   velocity_covariance(), gate)
                : constrain_newest(smoother, in_map(x, *speed, angular_rate), velocity_covariance(),
                                   gate);
    frame.wheels = found;
    if (found.is_rejected) ++events["wheel reading rejected by chi-square"];
  }
  rejected_in_a_row_ = found.is_rejected ? rejected_in_a_row_ + 1 : 0;
}

void WheelConstraint::constrain_last(FixedLagSmoother& smoother, const WheelSpeed& wheel_speed,
                                     const Eigen::Vector3d& angular_rate) const {
  const NavState& x = smoother.state(smoother.size() - 2);
  const auto speed = wheel_speed.taken_at(x.stamp);
  if (!speed) return;
  smoother.add_to_last(
      options_.form == WheelForm::kVelocity
          ? make_factor(WheelVelocityModel{*speed, mount_, angular_rate}, velocity_covariance())
          : make_factor(in_map(x, *speed, angular_rate), velocity_covariance()));
}

/// The book's form: turned into the map once, with the attitude of the moment.
WorldVelocityModel WheelConstraint::in_map(const NavState& x, double forward_mps,
                                           const Eigen::Vector3d& angular_rate) const {
  const Eigen::Vector3d v_body =
      mount_.R_wheels_body.transpose() * Eigen::Vector3d(forward_mps, 0, 0) -
      (angular_rate - x.gyro_bias).cross(mount_.p_body);
  return {x.q_map_body * v_body};
}

/// In the wheels' axes; the book knows one deviation for all directions.
Eigen::Matrix3d WheelConstraint::velocity_covariance() const {
  if (options_.form == WheelForm::kWorldVelocity) {
    return options_.forward_mps * options_.forward_mps * Eigen::Matrix3d::Identity();
  }
  const Eigen::Vector3d sigma(options_.forward_mps, options_.sideways_mps, options_.upwards_mps);
  return sigma.cwiseAbs2().asDiagonal();
}

}  // namespace traverse::inertial
