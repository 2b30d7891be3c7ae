#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "traverse/inertial/navigation.hpp"

#include "inertial/drive_faults.hpp"
#include "inertial/simulated_vehicle.hpp"

namespace traverse::testing {

/// A drive of the book's robot with all that its recording has: a heading only while it drives,
/// which scatters; RTK that steps to float and back; an IMU that shakes.
inline SimulatedDrive books_robot(std::uint32_t seed, double seconds) {
  SimulatedVehicle robot;
  robot.cruise_mps = 1.2;
  robot.road_scale = 0.1;
  robot.slope_rad = 0.01;
  robot.imu_from_axle.setZero();
  SimulatedSensors sensors;
  sensors.wheel_scale = 1;
  sensors.gnss_sigma_m = 0.015;
  sensors.seed = seed;
  sensors.heading_sigma_deg = 1.5;
  sensors.antenna_body = {-0.17, -0.2, 0};
  SimulatedDrive drive = simulate(robot, sensors, seconds);
  keep_headings_above(drive, 0.6);
  shake(drive, 1, 0.04, seed + 100);
  step_fixes(drive, 0.12, 8, 2, seed + 200);
  return drive;
}

/// The presets as they are shipped, told nothing of the recording.
inline inertial::NavigationOptions shipped_window() { return inertial::SlidingWindowOptions(); }
inline inertial::NavigationOptions shipped_two_frame(inertial::Trigger trigger) {
  inertial::NavigationOptions options = inertial::TwoFrameOptions();
  options.trigger = trigger;
  options.gnss.form = inertial::GnssForm::kPose;
  options.gnss.heading_deg = 1;
  options.wheels.use = trigger == inertial::Trigger::kGnssAndWheels;
  return options;
}

/// Steps of the path at fixes less the predicted ones.
struct Jumps {
  std::size_t fixes = 0;
  std::size_t many = 0;  ///< of more than 5 cm
  double p95_m = 0;
  double most_m = 0;
};
inline Jumps jumps_of(const std::vector<inertial::NavFrame>& frames, double from_s) {
  constexpr double kJump_m = 0.05;
  std::vector<double> sizes;
  for (const inertial::NavFrame& frame : frames) {
    if (frame.by_gnss && seconds_of(frame.state.stamp) > from_s) {
      sizes.push_back(frame.correction_map.norm());
    }
  }
  if (sizes.empty()) return {};
  std::sort(sizes.begin(), sizes.end());
  Jumps jumps;
  jumps.fixes = sizes.size();
  jumps.many = static_cast<std::size_t>(
      std::count_if(sizes.begin(), sizes.end(), [](double size) { return size > kJump_m; }));
  jumps.p95_m = sizes[sizes.size() * 95 / 100];
  jumps.most_m = sizes.back();
  return jumps;
}

}  // namespace traverse::testing
