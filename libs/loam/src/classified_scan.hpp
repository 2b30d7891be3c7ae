#pragma once

#include "traverse/geometry/pose3.hpp"
#include "traverse/lidar/corrected_scan.hpp"
#include "traverse/loam/features.hpp"
#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"

namespace traverse::loam {

/// lidar::corrected() with the feature class of each point.
/// \param velocity body twist a second, lidar frame; zero for a scan that is not deskewed
lidar::CorrectedScan corrected_and_classified(const sensors::LidarScan& scan,
                                              const sensors::LidarProfile& profile,
                                              const geometry::Twist& velocity,
                                              const FeatureOptions& options);

}  // namespace traverse::loam
