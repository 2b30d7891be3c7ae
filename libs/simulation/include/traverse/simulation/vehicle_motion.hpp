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
                std::optional<std::uint64_t> other_drive = {});

  double duration_s() const { return duration_s_; }
  const Route& route() const { return route_; }

  MotionState state(double seconds) const;
  /// Metres along the route (Route::at), their rate and the rate of that.
  Jet progress(double seconds) const;

 private:
  Route route_;
  Terrain terrain_;
  UniformSpline progress_, roll_, pitch_;
  double duration_s_ = 0;
};

}  // namespace traverse::simulation
