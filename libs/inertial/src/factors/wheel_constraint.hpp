#pragma once

#include "traverse/inertial/navigation.hpp"

#include "factors/wheel_jumps.hpp"
#include "navigation/map_fix.hpp"
#include "navigation/wheel_speed.hpp"
#include "residuals/wheel_velocity.hpp"
#include "residuals/world_velocity.hpp"
#include "smoother/fixed_lag_smoother.hpp"

namespace traverse::inertial {

/// What wheels constrain: a velocity in the form that the options ask for, or standing still.
class WheelConstraint {
 public:
  WheelConstraint(const WheelOptions& options, const WheelMount& mount)
      : options_(options), mount_(mount), jumps_(options.forward_mps) {}

  /// What else there is to judge wheels by.
  struct Trust {
    geometry::Stamp now;
    bool has_fixes = false;    ///< that were believed a moment ago
    bool has_heading = false;  ///< measured a moment ago: the book's velocity in the map needs it
  };

  /// Constrains the newest state by the readings that were not taken yet, if there are any.
  /// \param angular_rate  at the state, as the IMU read it
  void constrain(FixedLagSmoother& smoother, WheelSpeed& wheel_speed,
                 const Eigen::Vector3d& angular_rate, const Trust& trust, NavFrame& frame,
                 Events& events);

  /// Constrains the state before the newest by the readings that the newest has taken.
  /// \param angular_rate  at that state
  void constrain_last(FixedLagSmoother& smoother, const WheelSpeed& wheel_speed,
                      const Eigen::Vector3d& angular_rate, const Trust& trust) const;

 private:
  bool is_estimate_astray(const Trust& trust) const;
  void begin_again(FixedLagSmoother& smoother, const WheelVelocityResidual& told, NavFrame& frame,
                   Events& events);
  WorldVelocityResidual in_map(const NavState& x, double forward_mps,
                               const Eigen::Vector3d& angular_rate) const;
  Eigen::Matrix3d velocity_covariance(WheelForm form) const;

  WheelOptions options_;
  WheelMount mount_;
  std::optional<geometry::Stamp> disagree_since_;
  WheelJumps jumps_;
};

}  // namespace traverse::inertial
