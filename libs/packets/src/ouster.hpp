#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "traverse/packets/ouster_metadata.hpp"
#include "traverse/packets/packet_decoder.hpp"

namespace traverse::packets {

/// Bytes of a lidar packet of a sensor with this metadata.
std::size_t ouster_packet_bytes(const OusterMetadata& metadata);
inline constexpr std::size_t kOusterImuBytes = 48;

/// One reading of an Ouster's IMU (LEGACY profile), by the sensor's clock.
struct OusterImu {
  std::int64_t sensor_ns = 0;
  Eigen::Vector3d specific_force;  ///< [m/s^2]
  Eigen::Vector3d angular_rate;    ///< [rad/s]
};
/// Nothing if the packet has not the size of one or holds numbers that are none.
std::optional<OusterImu> decode_ouster_imu(Bytes packet);

/// Makes points of lidar packets, in the sensor frame. The intensity is the reflectivity, which all
/// profiles have; a pixel with two returns gives two points. Rings are rows, the highest first.
/// (ouster_core/src/parsing.cpp of ouster-lidar/ouster-sdk 46b7bce.)
class OusterDecoder : public PacketDecoder {
 public:
  explicit OusterDecoder(OusterMetadata metadata);

  PacketKind outline(Bytes packet, PacketOutline& outline) override;
  ReturnCounts append(Bytes packet, const PacketOutline& outline, std::size_t first,
                      std::size_t last, double zero_s, sensors::LidarScan& scan) const override;

  const OusterMetadata& metadata() const { return metadata_; }

 private:
  /// Where a pixel lies at the range r when its column stands at the encoder angle e, in the lidar
  /// frame: (r - n) * direction turned by e, + (n, 0) turned by e.
  struct Beam {
    float x, y, z;
  };
  struct Turn {
    float cos, sin;
  };
  std::size_t column_bytes() const;
  const std::uint8_t* column_at(Bytes packet, std::size_t column) const;
  bool is_valid(const std::uint8_t* column) const;

  OusterMetadata metadata_;
  std::vector<Beam> beams_;
  std::vector<Turn> turns_;  ///< by measurement id
  float origin_m_ = 0;       ///< beams begin so far from the axis
  float reach_m_ = 0;        ///< ranges are counted from the origin along the beam
  float height_m_ = 0;
  std::array<float, 12> T_sensor_lidar_{};  ///< metres
};

}  // namespace traverse::packets
