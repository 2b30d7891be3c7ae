#include "factors/gnss_constraint.hpp"

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"

#include "factors/gated_factor.hpp"

namespace traverse::inertial {

void GnssConstraint::constrain(FixedLagSmoother& smoother, const MapFix& fix,
                               const BodyMotion& motion, const NavState::Tangent& first_sigma,
                               NavFrame& frame, Events& events) {
  const AntennaFix antenna{fix.p_antenna_map, antenna_body_, motion.angular_rate,
                           motion.acceleration_map};
  frame.gnss_residual_enu = gnss_position_residual(antenna, smoother.newest());

  const bool gate = options_.gate && rejected_in_a_row_ < options_.max_rejected;
  if (options_.gate && !gate) {
    ++events["navigation begun again after too many fixes were rejected"];
    begin_again(smoother, fix, first_sigma);
    frame.restarted = true;
  }
  const bool as_pose = options_.form == GnssForm::kPose && fix.heading.has_value();
  frame.gnss = as_pose ? take_pose(smoother, fix, gate)
                       : constrain_newest(smoother, GnssPositionModel{antenna}, fix.covariance,
                                          gate, options_.huber);
  rejected_in_a_row_ = frame.gnss.is_rejected ? rejected_in_a_row_ + 1 : 0;
  if (frame.gnss.is_rejected) ++events["fix rejected by chi-square"];
  if (!as_pose && fix.heading) {
    const double sigma = options_.heading_deg * geometry::kDegree;
    frame.heading = constrain_newest(smoother, HeadingModel{*fix.heading},
                                     Covariance<HeadingModel>(sigma * sigma), gate, options_.huber);
    if (frame.heading.is_rejected) ++events["heading rejected by chi-square"];
  }
}

void GnssConstraint::constrain_last(FixedLagSmoother& smoother, const MapFix& fix) const {
  smoother.add_to_last(make_factor(GnssPositionModel{{fix.p_antenna_map, antenna_body_}},
                                   fix.covariance, options_.huber));
}

/// Fixes that disagree for so long are right, and the estimate is not: it begins again from here,
/// keeping what it knows of the biases.
void GnssConstraint::begin_again(FixedLagSmoother& smoother, const MapFix& fix,
                                 const NavState::Tangent& first_sigma) const {
  constexpr double kTilt = 0.05;    // rad
  constexpr double kHeading = 0.3;  // rad
  constexpr double kVelocity = 3;   // m/s
  constexpr double kBiasDoubt = 5;  // times the standard deviation that was believed
  NavState state = smoother.newest();
  NavState::Tangent sigma =
      (kBiasDoubt * smoother.covariance().diagonal().cwiseSqrt()).cwiseMin(first_sigma);
  state.p_map = fix.p_antenna_map - state.q_map_body * antenna_body_;
  sigma.segment<3>(NavState::kRotation) << kTilt, kTilt, kHeading;
  sigma.segment<3>(NavState::kPosition) = 10 * fix.covariance.diagonal().cwiseSqrt();
  sigma.segment<3>(NavState::kVelocity).setConstant(kVelocity);
  smoother.start(state, sigma);
}

/// The book's form: the antenna's place moved to the body with the heading that was measured, and
/// that heading as a whole rotation.
Innovation GnssConstraint::take_pose(FixedLagSmoother& smoother, const MapFix& fix,
                                     bool gate) const {
  GnssPoseModel model;
  model.T_map_body_measured.rotation = geometry::exp_so3({0, 0, *fix.heading});
  model.T_map_body_measured.translation =
      fix.p_antenna_map - model.T_map_body_measured.rotation * antenna_body_;
  const double sigma = options_.heading_deg * geometry::kDegree;
  Covariance<GnssPoseModel> R = Covariance<GnssPoseModel>::Zero();
  R.topLeftCorner<3, 3>() = sigma * sigma * Eigen::Matrix3d::Identity();
  R.bottomRightCorner<3, 3>() = fix.covariance;
  return constrain_newest(smoother, model, R, gate, options_.huber);
}

}  // namespace traverse::inertial
