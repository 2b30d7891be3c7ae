#include "traverse/simulation/wheel_simulator.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "simulation/motion_settings.hpp"

namespace traverse::simulation {
namespace {

WheelSettings without_errors() {
  WheelSettings settings;
  settings.radius_error = settings.slip_per_mps2 = settings.roughness = 0;
  return settings;
}

/// A loop on flat ground.
VehicleMotion flat_loop() {
  RouteSettings route;
  route.waypoints_m = {0, 0, 40, 0, 40, 30, 0, 30};
  route.closed = true;
  route.corner_radius_m = 8;
  route.standstill_s = 0.5;
  return {route, {}, Terrain({}, 1), 1};
}

TEST(WheelSimulator, WholePulsesOfTheWayThatEachWheelRolls) {
  const VehicleMotion motion = flat_loop();
  const WheelSettings settings = without_errors();
  WheelSimulator wheels(settings, motion, 1);
  const double metres_per_pulse =
      2 * std::numbers::pi * settings.radius_m / settings.pulses_per_turn;
  double left = 0;
  double right = 0;
  wheels.next();
  for (int i = 1; i < static_cast<int>(motion.duration_s() * settings.rate_hz); ++i) {
    const auto ways = wheels.exact_ways((i - 1) / settings.rate_hz, i / settings.rate_hz);
    left += ways.left;
    right += ways.right;
    const sensors::WheelOdometry sample = wheels.next();
    EXPECT_NEAR(static_cast<double>(sample.ticks->left) * metres_per_pulse, left,
                1.01 * metres_per_pulse);
    EXPECT_NEAR(static_cast<double>(sample.ticks->right) * metres_per_pulse, right,
                1.01 * metres_per_pulse);
  }
  // Once round to the left: the right wheel goes a track's circle farther.
  EXPECT_NEAR(right - left, 2 * std::numbers::pi * settings.track_m, 0.02);
}

TEST(WheelSimulator, ReckonedWithoutErrorsTheLoopCloses) {
  const VehicleMotion motion = flat_loop();
  WheelSimulator wheels(without_errors(), motion, 1);
  sensors::WheelOdometry last;
  const auto count = static_cast<int>(motion.duration_s() * without_errors().rate_hz);
  for (int i = 0; i < count; ++i) last = wheels.next();
  EXPECT_LT(last.T_odom_body->translation.norm(), 0.3);
  EXPECT_NEAR(last.velocity->forward_mps, 0, 1e-9);
}

TEST(WheelSimulator, ErrorsMakeTheWheelsDiffer) {
  const VehicleMotion motion({}, {}, Terrain({}, 1), 1);  // straight on
  WheelSettings settings;
  settings.radius_error = 0.01;
  WheelSimulator wheels(settings, motion, 2);
  sensors::WheelOdometry last;
  const auto count = static_cast<int>(motion.duration_s() * settings.rate_hz);
  for (int i = 0; i < count; ++i) last = wheels.next();
  EXPECT_NE(last.ticks->left, last.ticks->right);
  const double turns = 100 / (2 * std::numbers::pi * settings.radius_m);
  EXPECT_NEAR(static_cast<double>(last.ticks->left), turns * settings.pulses_per_turn,
              0.05 * turns * settings.pulses_per_turn);
}

}  // namespace
}  // namespace traverse::simulation
