#pragma once

#include <cstdint>
#include <vector>

#include "traverse/geometry/pose3.hpp"
#include "traverse/lidar/feature_class.hpp"
#include "traverse/lidar/scan_lines.hpp"
#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"

namespace traverse::lidar {

/// A scan as odometry used it: unusable points gone, elevation corrected, deskewed to the stamp.
/// For maps, scores and pictures; odometry itself only treats the points it needs.
struct CorrectedScan {
  std::vector<float> x, y, z;         ///< metres, lidar frame at the scan's stamp
  std::vector<std::uint32_t> source;  ///< index of the point in the LidarScan
  std::vector<FeatureClass> classes;  ///< empty, or one a point
};

/// \param velocity body twist a second, lidar frame; zero for a scan that is not deskewed
CorrectedScan corrected(const sensors::LidarScan& scan, const sensors::LidarProfile& profile,
                        const geometry::Twist& velocity);

/// The same of a scan that is organised already; takes the points out of `lines`.
CorrectedScan corrected(ScanLines lines, const sensors::LidarScan& scan,
                        const sensors::LidarProfile& profile, const geometry::Twist& velocity);

}  // namespace traverse::lidar
