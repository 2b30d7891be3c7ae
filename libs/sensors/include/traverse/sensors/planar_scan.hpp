#pragma once

#include <string>
#include <vector>

#include "traverse/geometry/stamp.hpp"

namespace traverse::sensors {

/// One sweep of a 2-D laser scanner, counterclockwise in the sensor's x-y plane.
struct PlanarScan {
  geometry::Stamp stamp;
  std::string sensor;
  double first_azimuth = 0;     ///< rad, of ranges[0]
  double azimuth_step = 0;      ///< rad between successive ranges, positive counterclockwise
  double max_range_m = 0;       ///< of the sensor
  std::vector<float> ranges_m;  ///< NaN where there was no return
};

}  // namespace traverse::sensors
