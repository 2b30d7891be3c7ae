#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "traverse/packets/packet_decoder.hpp"

/// Lidars' own packets as points, with the moment and the azimuth of each firing.
namespace traverse::packets {

/// How a laser of a Velodyne looks out of the head.
struct VelodyneLaser {
  double elevation = 0;              ///< [rad]
  double azimuth_correction = 0;     ///< taken off the head's azimuth [rad]
  double distance_correction_m = 0;  ///< added
  double vertical_offset_m = 0;
  double horizontal_offset_m = 0;
};

/// What data packets hold is alike in all models; when a laser fires is not.
enum class VelodyneModel {
  kVlp16,       ///< two firings of 16 lasers in a block, 55.296 us each
  kVlp16HiRes,  ///< the same, its lasers closer together
  kVlp32c,      ///< one firing of 32 lasers in a block, two at a time, 55.296 us; 4 mm units
  kHdl32e,      ///< one firing of 32 lasers in a block, 46.08 us
  kHdl64e,      ///< lasers 0 to 31 and 32 to 63 in blocks of their own, 48 us for both
  kVls128,      ///< four blocks a firing, eight lasers at a time, 53.3 us; 4 mm units
};

/// "VLP-32C"
std::string_view name_of(VelodyneModel model);

/// The payload of a data packet: twelve blocks of an azimuth and 32 returns, microseconds of the
/// hour, return mode, model.
inline constexpr std::size_t kVelodynePacketBytes = 1206;
using VelodynePacket = std::span<const std::uint8_t, kVelodynePacketBytes>;

/// Microseconds of the hour at which the first laser of the packet fired.
std::uint32_t velodyne_microseconds(VelodynePacket packet);
/// Whether all twelve blocks begin as blocks do. Of another packet nothing can be taken. (The last
/// four of a VLS-128 that sends two returns are not used.)
bool is_velodyne_data(VelodynePacket packet);
/// The model by the factory byte, the HDL-64E, which has none, by its blocks; nothing: of a model
/// that is not known.
std::optional<VelodyneModel> velodyne_model(VelodynePacket packet);
/// Returns in the packet; of two returns of one firing that are the same, one.
std::size_t velodyne_returns(VelodynePacket packet, VelodyneModel model);

/// The lasers by design, in the order of the packets; of the HDL-64E, whose lasers
/// differ from unit to unit, none.
std::vector<VelodyneLaser> velodyne_lasers(VelodyneModel model);

/// Makes points of packets. Firing times are those of ros-drivers/velodyne 29abd0e
/// (velodyne_pointcloud/src/lib/rawdata.cc), of the HDL-64E those of share/sensors/hdl64e.yaml.
class VelodyneDecoder : public PacketDecoder {
 public:
  /// \param lasers in the order of the packets: 16, 32, 64 or 128
  /// \throws std::invalid_argument if the model has another number
  VelodyneDecoder(VelodyneModel model, const std::vector<VelodyneLaser>& lasers);

  /// Appends each return of the packet as a point: metres (x where the azimuth is zero, y left,
  /// z up), intensity as stored, the laser as the ring, and its time after `zero_us`, microseconds
  /// of an hour that is at most half an hour away. A return is a distance that is not zero. Packets
  /// that are no data are left out. \returns the number of points
  std::size_t append(VelodynePacket packet, std::uint32_t zero_us, sensors::LidarScan& scan) const;

  PacketKind outline(Bytes packet, PacketOutline& outline) override;
  ReturnCounts append(Bytes packet, const PacketOutline& outline, std::size_t first,
                      std::size_t last, double zero_s, sensors::LidarScan& scan) const override;
  std::int64_t clock_period_ns() const override { return 3'600'000'000'000; }

 private:
  static constexpr std::size_t kMostBeams = 128;
  /// The beams of a firing of all lasers, in the order of the packet.
  struct Beams {
    std::array<float, kMostBeams> sin_elevation{}, cos_elevation{}, sin_azimuth{}, cos_azimuth{};
    std::array<float, kMostBeams> distance_m{}, vertical_m{}, horizontal_m{};
    std::array<float, kMostBeams> delay_us{};
    std::array<std::uint16_t, kMostBeams> ring{};
  };

  bool read_outline(VelodynePacket packet, PacketOutline& outline) const;
  /// Azimuths of the beams with the turn of the head until each of them fires.
  struct TurnedBeams {
    std::array<float, kMostBeams> sin_azimuth, cos_azimuth;
  };
  void turn_beams(double rate, TurnedBeams& turned) const;

  VelodyneModel model_;
  Beams beams_;
  std::size_t beam_count_ = 0;
  std::array<std::int32_t, 12> group_begin_ns_{};  ///< after the packet's time
  bool has_offsets_ = false;
  struct Last {
    std::int64_t us;
    std::int32_t azimuth;
  };
  std::optional<Last> last_;  ///< of a model whose packets hold one firing
};

}  // namespace traverse::packets
