#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "traverse/geometry/stamp.hpp"

namespace traverse::testing {

struct RecordedPacket {
  geometry::Stamp arrival;
  std::vector<std::uint8_t> bytes;
};

/// Packets of velodyne_msgs/VelodyneScan and pandar_msgs/PandarScan of a ROS 2 bag (sqlite3), in
/// order.
std::vector<RecordedPacket> packets_of_bag(const std::filesystem::path& db3);

/// The coordinates of a binary PCD file that begins with x y z as float32.
std::vector<std::array<float, 3>> points_of_pcd(const std::filesystem::path& pcd);

}  // namespace traverse::testing
