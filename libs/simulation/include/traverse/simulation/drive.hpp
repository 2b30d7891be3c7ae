#pragma once

#include "traverse/geometry/pose3.hpp"

namespace traverse::simulation {

/// A vehicle that follows y = amplitude sin(2 pi x / wavelength) at constant speed along x, with a
/// little roll and pitch: the exact pose at any time from one closed description.
struct Drive {
  double speed_mps = 10;   ///< along x
  double amplitude_m = 2;  ///< of the swerves
  double wavelength_m = 80;
  double sway = 0.01;           ///< amplitude of roll and pitch, rad
  double lidar_height_m = 1.8;  ///< above the ground

  /// T_map_lidar at `seconds` after the start. The map frame stands on the ground.
  geometry::Pose3 pose(double seconds) const;
};

}  // namespace traverse::simulation
