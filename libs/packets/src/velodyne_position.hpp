#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "traverse/packets/packet_decoder.hpp"

namespace traverse::packets {

/// What a Velodyne passes on of the receiver at its box (as MRPT 2.5.8 lays it
/// out, TVelodynePositionPacket in CObservationVelodyneScan.h).
struct VelodynePosition {
  std::uint32_t microseconds = 0;  ///< of the hour, by the lidar's clock
  std::string sentence;            ///< NMEA, without the line's end; empty: no receiver
};

inline constexpr std::size_t kVelodynePositionBytes = 512;

/// Nothing if the packet has not the size of one.
std::optional<VelodynePosition> decode_velodyne_position(Bytes packet);

}  // namespace traverse::packets
