#pragma once

#include <span>

#include "traverse/config/binder.hpp"
#include "traverse/geometry/pose3.hpp"
#include "traverse/loam/scan_to_map.hpp"

namespace traverse::loam {

/// A recording may begin at full speed; a scan-to-map odometry that starts from rest then lags for
/// many frames and never makes the loss good. So the first scans are held back and followed under
/// several hypotheses of the initial forward speed.
struct SpeedSearchOptions {
  int scans = 4;               ///< held back and followed; below 2: no search, start from rest
  double slowest_mps = -8;     ///< hypotheses: from here
  double fastest_mps = 44;     ///< to here
  double step_mps = 4;         ///< in these steps
  int registration_steps = 4;  ///< for each scan under each hypothesis
};
void bind(config::Binder& binder, SpeedSearchOptions& options);

/// The body twist a second at the first scan under which most features of the following ones find
/// their line or plane in a map built from the scans before. Planes that are nearly horizontal do
/// not count: the ground supports every speed. Zero if the scans do not tell (a tunnel).
/// \param first_scans at least two, in order of time
geometry::Twist find_initial_velocity(std::span<const ScanFeatures> first_scans,
                                      const sensors::LidarProfile& profile,
                                      const ScanToMapOptions& scan_to_map,
                                      const SpeedSearchOptions& options);

}  // namespace traverse::loam
