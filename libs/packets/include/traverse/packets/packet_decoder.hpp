#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "traverse/sensors/lidar_scan.hpp"

namespace traverse::packets {

/// The payload of one datagram.
using Bytes = std::span<const std::uint8_t>;

/// What a datagram is to the decoder of a lidar.
enum class PacketKind {
  kData,     ///< returns
  kOther,    ///< of a size or a beginning that data packets do not have
  kDamaged,  ///< begins like data, and contradicts itself
};

/// What a data packet says before its returns are looked at. Firings that share an azimuth (Ouster:
/// a column) are a group; groups stand in the order of firing.
struct PacketOutline {
  static constexpr std::size_t kMaxGroups = 64;
  static constexpr std::int32_t kTurn = 36000;  ///< of azimuths' units

  std::int64_t sensor_ns = 0;  ///< by the sensor's clock: the moment that times are counted from
  std::size_t groups = 0;
  std::array<std::int32_t, kMaxGroups> azimuth{};   ///< [0.01 deg] in the sense of the turn
  std::array<std::int32_t, kMaxGroups> begin_ns{};  ///< of a group's first firing, after sensor_ns
  bool has_frame = false;                           ///< the sensor numbers its sweeps
  std::uint32_t frame = 0;                          ///< of 16 bits
  bool is_dual = false;
  double rate = 0;       ///< of the head [rad/us]
  double period_us = 0;  ///< from one group to the next, where the packet tells
};

/// What became of the returns of a packet.
struct ReturnCounts {
  std::size_t returns = 0;   ///< distances that are not zero
  std::size_t repeated = 0;  ///< second returns of a firing at the distance of the first
  std::size_t points = 0;    ///< the rest

  ReturnCounts& operator+=(const ReturnCounts& other) {
    returns += other.returns;
    repeated += other.repeated;
    points += other.points;
    return *this;
  }
};

/// Makes points of the data packets of one lidar. Points are in the frame that the maker's own
/// programs give: Velodyne x where the azimuth is zero and y left of it, Hesai y where the azimuth
/// is zero and x right of it, Ouster the sensor frame; z is up.
class PacketDecoder {
 public:
  virtual ~PacketDecoder() = default;

  /// Reads the outline; only of data is `outline` filled.
  virtual PacketKind outline(Bytes packet, PacketOutline& outline) = 0;

  /// Appends the returns of the groups [first, last) of a data packet as points.
  /// \param zero_s of outline.sensor_ns after the scan's stamp [s]
  virtual ReturnCounts append(Bytes packet, const PacketOutline& outline, std::size_t first,
                              std::size_t last, double zero_s, sensors::LidarScan& scan) const = 0;

  /// After so long the sensor's clock begins again [ns]; 0: never.
  virtual std::int64_t clock_period_ns() const { return 0; }
};

}  // namespace traverse::packets
