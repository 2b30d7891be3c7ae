#pragma once

#include "traverse/config/binder.hpp"
#include "traverse/geometry/pose3.hpp"

namespace traverse::simulation {

/// Where a sensor sits on the vehicle and how it is turned.
struct Mounting {
  double x_m = 0, y_m = 0, z_m = 0;
  double roll_deg = 0, pitch_deg = 0, yaw_deg = 0;  ///< R = Rz(yaw) Ry(pitch) Rx(roll)

  geometry::Pose3 T_body_sensor() const;
};
void bind(config::Binder& binder, Mounting& mounting);

}  // namespace traverse::simulation
