#pragma once

#include "traverse/inertial/navigation.hpp"

#include "factors/rejected_fixes.hpp"
#include "factors/rejected_headings.hpp"
#include "navigation/map_fix.hpp"
#include "residuals/gnss_position.hpp"
#include "smoother/fixed_lag_smoother.hpp"

namespace traverse::inertial {

/// How the body moves at a state, as far as the factors of a fix need to know.
struct BodyMotion {
  Eigen::Vector3d angular_rate;      ///< as the IMU read it [rad/s]
  Eigen::Vector3d acceleration_map;  ///< m/s^2
};

/// What fixes constrain, in the form that the options ask for, and which of them are believed.
class GnssConstraint {
 public:
  GnssConstraint(const GnssOptions& options, const Eigen::Vector3d& antenna_body)
      : options_(options), antenna_body_(antenna_body) {}

  /// Constrains the newest state. \param first_sigma  of the first state's tangent; fixes that
  /// agree with each other for long and not with the estimate are believed, and the estimate begins
  /// again from them with at most that
  void constrain(FixedLagSmoother& smoother, const MapFix& fix, const BodyMotion& motion,
                 const NavState::Tangent& first_sigma, NavFrame& frame, Events& events);

  /// Constrains the state before the newest too, by a fix that lies at its moment.
  void constrain_last(FixedLagSmoother& smoother, const MapFix& fix) const;

  /// Whether a measured heading has just been taken, so that the estimate's is exact.
  bool has_heading(geometry::Stamp stamp) const;

 private:
  void judge_rejected(FixedLagSmoother& smoother, MapFix& fix, const NavState::Tangent& first_sigma,
                      NavFrame& frame, Events& events);
  void judge_headings(FixedLagSmoother& smoother, const MapFix& fix, const BodyMotion& motion,
                      const NavState::Tangent& first_sigma, NavFrame& frame, Events& events);
  void begin_again(FixedLagSmoother& smoother, const RejectedFixes::Line& line,
                   const NavState::Tangent& first_sigma) const;
  void take_heading(FixedLagSmoother& smoother, const MapFix& fix, NavFrame& frame) const;
  void take_pose(FixedLagSmoother& smoother, const MapFix& fix, const AntennaFix& antenna,
                 NavFrame& frame) const;
  void take_level_pose(FixedLagSmoother& smoother, const MapFix& fix, NavFrame& frame) const;

  GnssOptions options_;
  Eigen::Vector3d antenna_body_;
  /// How long rejected fixes have to agree with each other before they are believed.
  double patience_s(double speed_mps) const;
  bool is_in_step(const Eigen::Vector3d& residual) const;
  void take_loosely(FixedLagSmoother& smoother, const MapFix& fix, const AntennaFix& antenna,
                    NavFrame& frame) const;

  RejectedFixes rejected_;                       ///< since the last that was believed
  RejectedHeadings headings_;                    ///< all of the last seconds
  std::optional<geometry::Stamp> last_fix_;      ///< that was believed
  std::optional<geometry::Stamp> last_heading_;  ///< that was believed
};

}  // namespace traverse::inertial
