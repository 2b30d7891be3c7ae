#pragma once

#include "traverse/simulation/vehicle_motion.hpp"

namespace traverse::testing {

/// A short hilly drive with a corner each way and a stop.
inline simulation::RouteSettings winding_route() {
  simulation::RouteSettings route;
  route.waypoints_m = {0, 0, 40, 0, 40, 40, 80, 50};
  route.speed_mps = 8;
  route.stops_m = {60};
  route.stop_s = 1;
  route.standstill_s = 0.5;
  return route;
}

inline simulation::Terrain hills() { return {{3, 120}, 5}; }

inline simulation::VehicleMotion winding_drive() { return {winding_route(), {}, hills(), 9}; }

}  // namespace traverse::testing
