#pragma once

#include <filesystem>

#include "traverse/config/binder.hpp"
#include "traverse/sensors/lidar_scan.hpp"

namespace traverse::dataset {

inline constexpr const char* kVelodyne = "velodyne";  ///< the lidar's label in both layouts

enum class BinType { kFloat32, kFloat64 };

/// How a file without a header holds points: so many numbers each, of which the first are x, y, z
/// and, where there is a fourth, the intensity.
struct BinLayout {
  int columns = 4;
  BinType type = BinType::kFloat32;
};
void bind(config::Binder& binder, BinLayout& layout);

/// Reads a .bin file: little-endian numbers of one point after the other, as KITTI has them or as
/// `layout` says. Stamp and sensor are left to the caller.
/// \throws files::InputError if it cannot be read or does not hold whole points.
sensors::LidarScan read_kitti_bin(const std::filesystem::path& file, const BinLayout& layout = {});

/// Writes such a file, atomically; intensity 0 where the scan has none. \throws files::OutputError
void write_kitti_bin(const std::filesystem::path& file, const sensors::LidarScan& scan);

}  // namespace traverse::dataset
