#pragma once

#include <filesystem>
#include <optional>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/sensors/lidar_scan.hpp"

#include "point_clouds/point_time.hpp"
#include "point_clouds/scan_completion.hpp"

namespace traverse::dataset {

/// The names under which files hold what a scan has; null if there is none.
const FieldValues* intensity_of(const PointCloud& cloud);
const FieldValues* ring_of(const PointCloud& cloud);

/// The points of `cloud` as a scan with that stamp; rings only if the file has any, times only with
/// a convention to read them by.
/// \throws files::InputError if x, y or z is missing or a ring number is not 0 to 65535.
sensors::LidarScan scan_from_cloud(const PointCloud& cloud, geometry::Stamp stamp,
                                   const std::optional<PointTimeConvention>& time,
                                   const std::filesystem::path& file);

/// The scan's points with what is known of them: intensity, ring, time (float, seconds after the
/// stamp).
PointCloud cloud_from_scan(const sensors::LidarScan& scan, DerivedPointData derived);

}  // namespace traverse::dataset
