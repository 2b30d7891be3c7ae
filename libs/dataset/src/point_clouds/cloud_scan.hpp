#pragma once

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/sensors/lidar_scan.hpp"

#include "point_clouds/scan_completion.hpp"

namespace traverse::dataset {

/// The scan's points with what is known of them: intensity, ring, time (float, seconds after the
/// stamp).
PointCloud cloud_from_scan(const sensors::LidarScan& scan, DerivedPointData derived);

}  // namespace traverse::dataset
