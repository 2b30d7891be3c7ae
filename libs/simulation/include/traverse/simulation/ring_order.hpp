#pragma once

#include "traverse/geometry/pose3.hpp"
#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"

/// What the layout of KITTI's .bin files makes of a scan.
namespace traverse::simulation {

/// The points ring after ring, each ring counterclockwise from straight ahead.
sensors::LidarScan in_ring_order(const sensors::LidarScan& scan);

/// The profile of scans in that order without rings and times: both are found from the points, with
/// intensities between 0 and 1.
sensors::LidarProfile in_ring_order(sensors::LidarProfile profile);

/// T_lidar_camera of a camera at the lidar's place: x right, y down, z ahead.
geometry::Pose3 camera_axes();

}  // namespace traverse::simulation
