#pragma once

#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"

namespace traverse::dataset {

/// What a profile tells of a scan and the scan does not hold itself: rings and times.
struct DerivedPointData {
  std::vector<std::uint16_t> ring;  ///< empty if they cannot be found
  std::vector<float> time;          ///< empty if they are not known
};

DerivedPointData derive_point_data(const sensors::LidarScan& scan,
                                   const sensors::LidarProfile& profile);

}  // namespace traverse::dataset
