#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "traverse/config/binder.hpp"
#include "traverse/geometry/pose3.hpp"
#include "traverse/simulation/route.hpp"
#include "traverse/simulation/terrain.hpp"

namespace traverse::simulation {

/// How the body moves on its wheels.
struct SuspensionSettings {
  double roll_deg_per_mps2 = 0.35;  ///< out of a corner, by lateral acceleration
  double pitch_deg_per_mps2 = 0.3;  ///< nose down when braking
  double natural_hz = 1.3;
  double damping = 0.35;       ///< share of the critical one
  double roughness_deg = 0.1;  ///< rms of what the road adds at full speed
};
void bind(config::Binder& binder, SuspensionSettings& settings);

/// How a person carries the body along the route, in place of wheels that only roll: everything
/// grows with the speed, so that who stands stands still.
struct GaitSettings {
  double turn_deg = 0;   ///< amplitude of looking left and right of the way
  double turn_hz = 0.5;  ///< of it
  double step_hz = 1.8;  ///< steps a second
  double bob_m = 0;      ///< amplitude of up and down, once a step
  double sway_m = 0;     ///< of left and right, once in two steps
  double tilt_deg = 0;   ///< of pitch, once a step, and of roll, once in two
};
void bind(config::Binder& binder, GaitSettings& settings);

/// A rigid body that moves, at one moment. Map: x east, y north, z up. Body: middle of the rear
/// axle on the ground, x ahead, y left, z up.
struct MotionState {
  geometry::Pose3 T_map_body;
  Eigen::Vector3d velocity_map;
  Eigen::Vector3d acceleration_map;
  Eigen::Vector3d angular_rate_body;          ///< rad/s
  Eigen::Vector3d angular_acceleration_body;  ///< rad/s^2

  /// The same body seen at another frame fixed to it.
  MotionState at(const geometry::Pose3& T_body_sensor) const;
  /// Pose a short time later (below 0.1 ms it is exact to rounding): second-order expansion.
  geometry::Pose3 pose_after(double seconds) const;
};

/// The drive: pose, velocity, angular rate and acceleration at any time, all from one closed
/// description (quintic splines in time for progress, roll and pitch; in space for the route; waves
/// for the ground), differentiated exactly.
class VehicleMotion {
 public:
  /// \param seed of the road's bumps
  /// \param other_drive seed of another driver's bumps, line and pace; nothing: exactly `route`
  /// \throws ImpossibleRoute
  VehicleMotion(const RouteSettings& route, const SuspensionSettings& suspension,
                const Terrain& terrain, std::uint64_t seed,
                std::optional<std::uint64_t> other_drive = {}, const GaitSettings& gait = {});

  double duration_s() const { return duration_s_; }
  const Route& route() const { return route_; }

  MotionState state(double seconds) const;
  /// Metres along the route (Route::at), their rate and the rate of that.
  Jet progress(double seconds) const;

 private:
  Route route_;
  Terrain terrain_;
  UniformSpline progress_, roll_, pitch_;
  UniformSpline turn_, bob_, sway_;  // of a gait
  bool is_carried_ = false;
  double duration_s_ = 0;
};

}  // namespace traverse::simulation
