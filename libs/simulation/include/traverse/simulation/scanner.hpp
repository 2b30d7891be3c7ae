#pragma once

#include <cstdint>

#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"
#include "traverse/simulation/analytic_scene.hpp"
#include "traverse/simulation/drive.hpp"

namespace traverse::simulation {

/// A spinning lidar whose every ray leaves from where the sensor is at that moment.
struct Scanner {
  sensors::LidarProfile profile;  ///< beams, range, sweep, turning direction
  int azimuth_steps = 1024;       ///< firings of each beam in a revolution
  double range_noise_m = 0;       ///< standard deviation
  std::uint32_t seed = 1;         ///< of the noise; each scan has its own stream

  /// The sweep whose stamp is `seconds` after the start of the drive. Points without a return are
  /// absent; rings and times are stored with the points, in firing order (all beams of a column).
  sensors::LidarScan scan(const AnalyticScene& scene, const Drive& drive, double seconds) const;
};

/// A 64-beam lidar, 10 Hz, -24.8 to +2 degrees, with rings and times in the data.
Scanner demo_scanner();

}  // namespace traverse::simulation
