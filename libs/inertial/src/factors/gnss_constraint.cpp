#include "factors/gnss_constraint.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"

#include "factors/gated_factor.hpp"
#include "residuals/gnss_pose.hpp"
#include "residuals/gnss_position.hpp"
#include "residuals/heading.hpp"

namespace traverse::inertial {

namespace {

constexpr double kAtOnce_s = 1;          // from the last fix that was believed
constexpr double kDeadReckoning_s = 10;  // by the IMU alone, to a metre

bool contradicts(const Eigen::Vector3d& difference, const Eigen::Matrix3d& covariance) {
  return !(difference.dot(covariance.ldlt().solve(difference)) <= chi2_bound(3));
}

}  // namespace

void GnssConstraint::constrain(FixedLagSmoother& smoother, const MapFix& told,
                               const BodyMotion& motion, const NavState::Tangent& first_sigma,
                               NavFrame& frame, Events& events) {
  MapFix fix = told;
  const AntennaFix antenna{fix.p_antenna_map, antenna_body_, motion.angular_rate,
                           motion.acceleration_map};
  frame.gnss_residual_enu = GnssPositionResidual{antenna}(smoother.newest());
  if (options_.gate) judge_rejected(smoother, fix, first_sigma, frame, events);
  if (options_.gate && fix.heading) {
    judge_headings(smoother, fix, motion, first_sigma, frame, events);
  }
  const double heading_residual =
      fix.heading ? HeadingResidual{*fix.heading}(smoother.newest())[0] : 0;

  const bool as_pose = options_.form == GnssForm::kPose && fix.heading.has_value();
  const bool agrees = !contradicts(frame.gnss_residual_enu, fix.covariance);
  if (is_in_step(frame.gnss_residual_enu) && !agrees) {
    take_loosely(smoother, fix, antenna, frame);
    ++events["fix after a step of the receiver, weighed by how far off it is"];
  } else if (as_pose && options_.level_pose) {
    take_level_pose(smoother, fix, frame);
  } else if (as_pose) {
    take_pose(smoother, fix, antenna, frame);
  } else {
    frame.gnss = constrain_newest(smoother, GnssPositionResidual{antenna}, fix.covariance,
                                  options_.gate, options_.huber);
    if (fix.heading) take_heading(smoother, fix, frame);
  }
  if (frame.gnss.is_rejected) {
    ++events["fix rejected by chi-square"];
    rejected_.add(fix.stamp, frame.gnss_residual_enu, told.covariance);
  } else {
    rejected_.clear();
    last_fix_ = fix.stamp;
  }
  if (frame.heading.is_rejected) ++events["heading rejected by chi-square"];
  if (frame.heading.rows > 0) {
    headings_.add(fix.stamp, heading_residual, fix.heading_sigma, frame.heading.is_rejected);
    if (!frame.heading.is_rejected) last_heading_ = fix.stamp;
  }
}

bool GnssConstraint::has_heading(geometry::Stamp stamp) const {
  constexpr double kHolds = 1;  // s; a gyro's bias is then good for a thousandth of a radian
  return last_heading_ && geometry::seconds_between(*last_heading_, stamp) <= kHolds;
}

void GnssConstraint::constrain_last(FixedLagSmoother& smoother, const MapFix& fix) const {
  smoother.add_to_last(make_factor(GnssPositionResidual{{fix.p_antenna_map, antenna_body_}},
                                   fix.covariance, options_.huber));
}

/// Who is right, when fixes were rejected for long: those that scatter more than they say are
/// weighed by their scatter; those that agree with each other and with the motion, and still not
/// with the estimate, are right, and the estimate begins again from what they say together. The
/// newest then passes the gate as any other, or does not.
void GnssConstraint::judge_rejected(FixedLagSmoother& smoother, MapFix& fix,
                                    const NavState::Tangent& first_sigma, NavFrame& frame,
                                    Events& events) {
  if (rejected_.empty() || is_in_step(frame.gnss_residual_enu)) return;
  RejectedFixes with_this = rejected_;
  with_this.add(fix.stamp, frame.gnss_residual_enu, fix.covariance);
  const auto line = with_this.line(patience_s(smoother.newest().v_map.norm()));
  if (!line) return;
  fix.covariance = line->of_fix;
  const Eigen::Matrix3d P =
      smoother.covariance().block<3, 3>(NavState::kPosition, NavState::kPosition);
  if (!contradicts(line->offset, P + line->of_offset)) {
    ++events["fix weighed by its scatter, which is larger than it says"];
    return;
  }
  ++events["navigation begun again after too many fixes were rejected"];
  begin_again(smoother, *line, first_sigma);
  frame.restarted = true;
  rejected_.clear();
}

/// Who is right, when most headings of seconds are rejected and agree with each other: they, if the
/// way of the vehicle says so too. It goes ahead or backwards, so that its velocity, which fixes
/// tell whatever the heading, is nearer to the right one; mounted otherwise than stated, antennas
/// agree with each other and not with the way.
void GnssConstraint::judge_headings(FixedLagSmoother& smoother, const MapFix& fix,
                                    const BodyMotion& motion, const NavState::Tangent& first_sigma,
                                    NavFrame& frame, Events& events) {
  constexpr double kLeastOffset = 0.15;  // rad; less the estimate finds by itself
  constexpr double kLeastSpeed = 0.3;    // m/s
  constexpr double kArm_m = 2;           // from the rear axle to the IMU, which a turn swings aside
  constexpr double kAside = 0.1;         // rad
  constexpr double kSure = 4;            // standard deviations of the velocity
  constexpr double kDoubt = 5;           // times the standard deviation that was believed
  const auto offset = headings_.offset(options_.longest_rejection_s);
  if (!offset || std::abs(*offset) < kLeastOffset || frame.restarted) return;
  const NavState& x = smoother.newest();
  const NavState::Matrix& P = smoother.covariance();
  const Eigen::Vector2d v = x.v_map.head<2>();
  const double v_sigma = std::sqrt(P.block<2, 2>(NavState::kVelocity, NavState::kVelocity).trace());
  if (v.norm() < std::max(kLeastSpeed, kSure * v_sigma)) return;
  if (std::abs(motion.angular_rate.z()) * kArm_m > kAside * v.norm()) return;
  const auto off_its_way = [&](double heading) {
    return std::abs(std::remainder(std::atan2(v.y(), v.x()) - heading, std::numbers::pi));
  };
  const Eigen::Matrix3d R = x.rotation();
  const double estimated = std::atan2(R(1, 0), R(0, 0));
  const double measured = estimated - *offset;
  // Half a turn, as of antennas that are taken for each other, leaves both as near to the way.
  const bool is_right =
      off_its_way(estimated) > kAside && off_its_way(measured) < off_its_way(estimated) / 2;
  if (!is_right) return;
  ++events["navigation begun again after too many headings were rejected"];
  NavState state = x;
  state.q_map_body = (geometry::exp_quaternion({0, 0, -*offset}) * x.q_map_body).normalized();
  state.p_map += (R - state.rotation()) * antenna_body_;
  NavState::Tangent sigma = (kDoubt * P.diagonal().cwiseSqrt()).cwiseMin(first_sigma);
  sigma[NavState::kRotation + 2] = fix.heading_sigma;
  smoother.start(state, sigma);
  frame.restarted = true;
  headings_.clear();
}

/// An estimate leaves the fixes as fast as a vehicle can move without its wheels telling: locked
/// ones hide all of its speed. What is farther off at once is a jump of the receiver, and fixes
/// that jumped together come back together: they are believed when dead reckoning would no longer
/// be.
double GnssConstraint::patience_s(double speed_mps) const {
  constexpr double kUnseen_mps2 = 20;  // twice what tyres hold
  constexpr double kSlip = 2;          // times the speed, of wheels that lock or spin
  const double longest_s = options_.longest_rejection_s;
  if (!last_fix_) return longest_s;
  const double seconds = geometry::seconds_between(*last_fix_, rejected_.first_stamp());
  const double by_driving_m = (kSlip * speed_mps + 0.5 * kUnseen_mps2 * seconds) * seconds;
  const bool jumped = rejected_.first_residual().norm() > by_driving_m;
  return jumped ? std::max(longest_s, kDeadReckoning_s) : longest_s;
}

/// Whether those before were off at once by a decimetre or two, as of a receiver that goes over to
/// float ambiguities.
bool GnssConstraint::is_in_step(const Eigen::Vector3d& residual) const {
  constexpr double kLargest_m = 1;
  if (!options_.gate || !last_fix_ || rejected_.empty()) return false;
  if (geometry::seconds_between(*last_fix_, rejected_.first_stamp()) > kAtOnce_s) return false;
  return rejected_.first_residual().norm() <= kLargest_m && residual.norm() <= kLargest_m;
}

/// As good as it is far off, and the better the longer: what one second of such fixes says they say
/// as one, for they err alike. Left out altogether, fixes that come back would find an estimate
/// whose velocity nothing has held meanwhile; and those that do not would pull it over in one leap,
/// as soon as its own doubt has grown enough, with a certainty that they do not have.
void GnssConstraint::take_loosely(FixedLagSmoother& smoother, const MapFix& fix,
                                  const AntennaFix& antenna, NavFrame& frame) const {
  const GnssPositionResidual model{antenna};
  Jacobian<3> J;
  const Residual<3> r = model(smoother.newest(), &J);
  frame.gnss = innovation(r, J, smoother.covariance(), fix.covariance);
  frame.gnss.is_rejected = true;
  constexpr double kAlike_s = 1;
  const double seconds = geometry::seconds_between(rejected_.first_stamp(), fix.stamp);
  const double variance = r.squaredNorm() / std::max(1.0, seconds / kAlike_s);
  const Eigen::Matrix3d R = fix.covariance + variance * Eigen::Matrix3d::Identity();
  smoother.add(make_factor(model, R, options_.huber));
  if (fix.heading) take_heading(smoother, fix, frame);
}

/// Gives up of the estimate what the fixes contradict: the place, and the velocity, with the
/// attitude that led to it, if that disagrees too. Biases and calibration stay, with some doubt.
void GnssConstraint::begin_again(FixedLagSmoother& smoother, const RejectedFixes::Line& line,
                                 const NavState::Tangent& first_sigma) const {
  constexpr double kTilt = 0.05;    // rad
  constexpr double kHeading = 0.3;  // rad
  constexpr double kVelocity = 3;   // m/s
  constexpr double kDoubt = 5;      // times the standard deviation that was believed
  NavState state = smoother.newest();
  const NavState::Matrix& P = smoother.covariance();
  NavState::Tangent sigma = (kDoubt * P.diagonal().cwiseSqrt()).cwiseMin(first_sigma);
  state.p_map -= line.offset;
  sigma.segment<3>(NavState::kPosition) = line.of_fix.diagonal().cwiseSqrt();
  const Eigen::Matrix3d P_v = P.block<3, 3>(NavState::kVelocity, NavState::kVelocity);
  if (contradicts(line.slope, P_v + line.of_slope)) {
    state.v_map -= line.slope;
    sigma.segment<3>(NavState::kRotation) << kTilt, kTilt, kHeading;
    sigma.segment<3>(NavState::kVelocity).setConstant(kVelocity);
  }
  smoother.start(state, sigma);
}

void GnssConstraint::take_heading(FixedLagSmoother& smoother, const MapFix& fix,
                                  NavFrame& frame) const {
  const double variance = fix.heading_sigma * fix.heading_sigma;
  frame.heading =
      constrain_newest(smoother, HeadingResidual{*fix.heading},
                       Covariance<HeadingResidual>(variance), options_.gate, options_.huber);
}

/// The six-row pose from a place and a heading, neither of which tells roll and pitch: those are
/// the estimate's own, and weigh next to nothing. Place and heading are gated apart; where one is
/// wrong the other is taken alone.
void GnssConstraint::take_pose(FixedLagSmoother& smoother, const MapFix& fix,
                               const AntennaFix& antenna, NavFrame& frame) const {
  const NavState& x = smoother.newest();
  const double heading_sigma = fix.heading_sigma;
  const Covariance<HeadingResidual> R_heading(heading_sigma * heading_sigma);
  const auto judge = [&](const auto& residual, const auto& R) {
    using Model = std::decay_t<decltype(residual)>;
    Jacobian<Model::kSize> J;
    const Residual<Model::kSize> r = residual(x, &J);
    Innovation found = innovation(r, J, smoother.covariance(), R);
    found.is_rejected = options_.gate && !(found.chi2 <= chi2_bound(Model::kSize));
    return found;
  };
  frame.gnss = judge(GnssPositionResidual{antenna}, fix.covariance);
  const HeadingResidual heading{*fix.heading};
  frame.heading = judge(heading, R_heading);
  if (frame.gnss.is_rejected && frame.heading.is_rejected) return;
  if (frame.heading.is_rejected) {
    smoother.add(make_factor(GnssPositionResidual{antenna}, fix.covariance, options_.huber));
    return;
  }
  if (frame.gnss.is_rejected) {
    smoother.add(make_factor(heading, R_heading, options_.huber));
    return;
  }
  const double turn = -heading(x)[0];  // from the estimate's heading to the one measured
  GnssPoseResidual model;
  model.T_map_body_measured.rotation = geometry::exp_so3({0, 0, turn}) * x.rotation();
  // The antenna's place as the estimate's latency and bias of fixes have it, at the body.
  const Eigen::Vector3d arm_map = model.T_map_body_measured.rotation * antenna_body_;
  const Eigen::Vector3d at_estimate = x.rotation() * antenna_body_;
  model.T_map_body_measured.translation = x.p_map - frame.gnss_residual_enu + at_estimate - arm_map;
  const double tilt_sigma = options_.tilt_deg * geometry::kDegree;
  // In the body's axes, where the vertical is the third but for the slope.
  const Eigen::Vector3d rotation_sigma(tilt_sigma, tilt_sigma, heading_sigma);
  Covariance<GnssPoseResidual> R = Covariance<GnssPoseResidual>::Zero();
  R.topLeftCorner<3, 3>() = rotation_sigma.cwiseAbs2().asDiagonal();
  // The lever arm turned by a heading that errs.
  const Eigen::Vector3d swept = heading_sigma * Eigen::Vector3d::UnitZ().cross(arm_map);
  R.bottomRightCorner<3, 3>() = fix.covariance + swept * swept.transpose();
  smoother.add(make_factor(model, R, options_.huber));
}

/// The book's form to the letter: the antenna's place moved to the body as on level ground, and the
/// heading as a whole rotation; one gate for all six rows.
void GnssConstraint::take_level_pose(FixedLagSmoother& smoother, const MapFix& fix,
                                     NavFrame& frame) const {
  GnssPoseResidual model;
  model.T_map_body_measured.rotation = geometry::exp_so3({0, 0, *fix.heading});
  model.T_map_body_measured.translation =
      fix.p_antenna_map - model.T_map_body_measured.rotation * antenna_body_;
  const double sigma = fix.heading_sigma;
  Covariance<GnssPoseResidual> R = Covariance<GnssPoseResidual>::Zero();
  R.topLeftCorner<3, 3>() = sigma * sigma * Eigen::Matrix3d::Identity();
  R.bottomRightCorner<3, 3>() = fix.covariance;
  frame.gnss = constrain_newest(smoother, model, R, options_.gate, options_.huber);
}

}  // namespace traverse::inertial
