#pragma once

#include "traverse/inertial/navigation.hpp"

#include "navigation/map_fix.hpp"
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
  /// disagree for too long are believed, and the estimate begins again from them with at most that
  void constrain(FixedLagSmoother& smoother, const MapFix& fix, const BodyMotion& motion,
                 const NavState::Tangent& first_sigma, NavFrame& frame, Events& events);

  /// Constrains the state before the newest too, by a fix that lies at its moment.
  void constrain_last(FixedLagSmoother& smoother, const MapFix& fix) const;

 private:
  Innovation take_pose(FixedLagSmoother& smoother, const MapFix& fix, bool gate) const;
  void begin_again(FixedLagSmoother& smoother, const MapFix& fix,
                   const NavState::Tangent& first_sigma) const;

  GnssOptions options_;
  Eigen::Vector3d antenna_body_;
  int rejected_in_a_row_ = 0;
};

}  // namespace traverse::inertial
