#pragma once

#include <functional>

#include "traverse/bags/message_value.hpp"
#include "traverse/geometry/stamp.hpp"
#include "traverse/packets/packet_lidars.hpp"

namespace traverse::dataset {

/// What the packets of a topic are of.
struct PacketTopic {
  packets::PacketLidar lidar;
  bool has_absolute_clock = false;  ///< see packets::SensorClock
};

/// Calls `use` with each packet of a message and when it arrived, in their order: of VelodyneScan,
/// PandarScan and NebulaPackets, which hold many with a stamp each (of zero: that of the header),
/// and of PacketMsg, which holds one.
/// \param log_time of a packet without a stamp
/// \throws UnusableMessage without packets, or if one is said to be larger than its room
void for_each_packet(const bags::MessageValue& message, geometry::Stamp log_time,
                     const std::function<void(packets::Bytes, geometry::Stamp)>& use);

}  // namespace traverse::dataset
