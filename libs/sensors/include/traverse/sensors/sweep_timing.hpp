#pragma once

#include <vector>

#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"

namespace traverse::sensors {

/// Share of the sweep that is over when the head looks at `azimuth` [rad, counterclockwise from
/// ahead], in [0, 1). For a Velodyne on KITTI this is 0.5 (1 - atan2(y, x) / pi).
double sweep_fraction(double azimuth, const LidarProfile& profile);

/// Seconds after the scan's stamp for each point, by the profile's time_source; empty when the
/// time is unknown (source none, or data without times).
std::vector<float> point_times(const LidarScan& scan, const LidarProfile& profile);

}  // namespace traverse::sensors
