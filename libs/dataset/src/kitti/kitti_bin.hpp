#pragma once

#include <filesystem>

#include "traverse/sensors/lidar_scan.hpp"

namespace traverse::dataset {

inline constexpr const char* kVelodyne = "velodyne";  ///< the lidar's label in both layouts

/// Reads a .bin file: x, y, z and intensity of one point after the other, float32, little-endian.
/// Stamp and sensor are left to the caller.
/// \throws files::InputError if it cannot be read or does not hold whole points.
sensors::LidarScan read_kitti_bin(const std::filesystem::path& file);

/// Writes such a file, atomically; intensity 0 where the scan has none. \throws files::OutputError
void write_kitti_bin(const std::filesystem::path& file, const sensors::LidarScan& scan);

}  // namespace traverse::dataset
