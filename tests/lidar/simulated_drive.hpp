#pragma once

#include <vector>

#include "traverse/sensors/lidar_scan.hpp"
#include "traverse/simulation/scanner.hpp"
#include "traverse/simulation/worlds.hpp"

namespace traverse::testing {

inline simulation::Drive swerving() {
  simulation::Drive drive;
  drive.speed_mps = 12;
  drive.amplitude_m = 3;
  drive.wavelength_m = 40;  // up to 0.9 rad/s
  return drive;
}

/// Scans of a simulated drive at 10 Hz, with the true poses relative to the first.
struct SimulatedDrive {
  simulation::Drive drive;
  simulation::Scanner scanner = simulation::demo_scanner();
  std::vector<sensors::LidarScan> scans;
  std::vector<geometry::Pose3> truth;

  SimulatedDrive(const simulation::AnalyticScene& scene, int count, double speed_mps)
      : SimulatedDrive(scene, count, simulation::Drive{speed_mps}) {}

  SimulatedDrive(const simulation::AnalyticScene& scene, int count,
                 const simulation::Drive& vehicle)
      : drive(vehicle) {
    scanner.azimuth_steps = 900;
    for (int i = 0; i < count; ++i) {
      const double t = 0.1 * i;
      scans.push_back(scanner.scan(scene, drive, t));
      truth.push_back(drive.pose(0).inverse() * drive.pose(t));
    }
  }
};

}  // namespace traverse::testing
