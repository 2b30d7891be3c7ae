#pragma once

#include "traverse/inertial/navigation.hpp"

#include "navigation/map_fix.hpp"
#include "navigation/wheel_speed.hpp"
#include "smoother/fixed_lag_smoother.hpp"

namespace traverse::inertial {

/// What wheels constrain: a velocity in the form that the options ask for, or standing still.
class WheelConstraint {
 public:
  WheelConstraint(const WheelOptions& options, const WheelMount& mount)
      : options_(options), mount_(mount) {}

  /// Constrains the newest state by the readings that were not taken yet, if there are any.
  /// \param angular_rate  at the state, as the IMU read it
  void constrain(FixedLagSmoother& smoother, WheelSpeed& wheel_speed,
                 const Eigen::Vector3d& angular_rate, NavFrame& frame, Events& events);

  /// Constrains the state before the newest by the readings that the newest has taken.
  /// \param angular_rate  at that state
  void constrain_last(FixedLagSmoother& smoother, const WheelSpeed& wheel_speed,
                      const Eigen::Vector3d& angular_rate) const;

 private:
  WorldVelocityModel in_map(const NavState& x, double forward_mps,
                            const Eigen::Vector3d& angular_rate) const;
  Eigen::Matrix3d velocity_covariance() const;

  WheelOptions options_;
  WheelMount mount_;
  int rejected_in_a_row_ = 0;
};

}  // namespace traverse::inertial
