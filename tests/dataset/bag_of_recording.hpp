#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"

#include "bags/bag_writers.hpp"

namespace traverse::testing {

/// Everything that a recording holds as messages of a vehicle: /points, /imu, /fix, and /tf_static
/// with the mountings in base_link. Scans are logged when they are over.
std::vector<MadeMessage> messages_of(dataset::Source& source, Wire wire);

/// A scan as a sensor_msgs/PointCloud2 with x, y, z, intensity, ring and time (seconds after the
/// stamp).
std::string message_of_scan(const sensors::LidarScan& scan, std::string_view frame, Wire wire);

/// Kinds of bags that a recording is told in.
struct BagKind {
  std::string name;       ///< "bag_lz4"
  std::string extension;  ///< ".bag"; empty: a folder
};
std::vector<BagKind> bag_kinds();
/// \returns its path
std::filesystem::path write_bag(const BagKind& kind, const std::filesystem::path& folder,
                                dataset::Source& source);

}  // namespace traverse::testing
