#include "ouster.hpp"

#include <bit>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "byte_fields.hpp"
#include "point_rows.hpp"

namespace traverse::packets {

namespace {

/// Where things stand in a packet.
struct OusterLayout {
  std::size_t packet_header;
  std::size_t column_header;
  std::size_t pixel;
  std::size_t column_footer;
  std::size_t packet_footer;
  std::size_t reflectivity_at;  ///< in a pixel
  std::size_t second_at;        ///< of the second return; 0: there is none
  std::size_t second_reflectivity_at;
  std::uint32_t range_mask;
  unsigned range_shift;  ///< to millimetres
};

OusterLayout layout_of(OusterProfile profile) {
  constexpr std::uint32_t k20Bits = (1U << 20) - 1;
  constexpr std::uint32_t k19Bits = (1U << 19) - 1;
  constexpr std::uint32_t k15Bits = (1U << 15) - 1;
  switch (profile) {
    case OusterProfile::kLegacy:
      return {0, 16, 12, 4, 0, 4, 0, 0, k20Bits, 0};
    case OusterProfile::kSingle:
      return {32, 12, 12, 0, 32, 4, 0, 0, k19Bits, 0};
    case OusterProfile::kDual:
      return {32, 12, 16, 0, 32, 3, 4, 7, k19Bits, 0};
    case OusterProfile::kLowBandwidth:
      return {32, 12, 4, 0, 32, 2, 0, 0, k15Bits, 3};
    case OusterProfile::kDualLowBandwidth:
      return {32, 12, 8, 0, 32, 2, 4, 6, k15Bits, 3};
  }
  return {};
}

/// At least two bytes of a pixel follow each range.
std::uint32_t range_at(const std::uint8_t* from, const OusterLayout& layout) {
  return (u32_at(from) & layout.range_mask) << layout.range_shift;
}

constexpr std::size_t kTimestampAt = 0;  // in a column
constexpr std::size_t kMeasurementAt = 8;
constexpr std::size_t kStatusAt = 10;       // not of legacy packets
constexpr std::size_t kLegacyFrameAt = 10;  // of legacy packets
constexpr std::size_t kFrameAt = 2;         // in the packet's header

}  // namespace

std::size_t ouster_packet_bytes(const OusterMetadata& metadata) {
  const OusterLayout layout = layout_of(metadata.profile);
  const std::size_t column =
      layout.column_header + metadata.rows() * layout.pixel + layout.column_footer;
  return layout.packet_header + metadata.columns_per_packet * column + layout.packet_footer;
}

std::optional<OusterImu> decode_ouster_imu(Bytes packet) {
  if (packet.size() != kOusterImuBytes) return std::nullopt;
  constexpr double kG = 9.80665;
  constexpr double kRadiansPerDegree = std::numbers::pi / 180;
  OusterImu imu;
  imu.sensor_ns = static_cast<std::int64_t>(u64_at(packet.data() + 8));
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint8_t* from = packet.data() + 24 + 4 * axis;
    imu.specific_force[axis] = static_cast<double>(std::bit_cast<float>(u32_at(from))) * kG;
    imu.angular_rate[axis] =
        static_cast<double>(std::bit_cast<float>(u32_at(from + 12))) * kRadiansPerDegree;
  }
  if (!imu.specific_force.allFinite() || !imu.angular_rate.allFinite() || imu.sensor_ns <= 0) {
    return std::nullopt;
  }
  return imu;
}

OusterDecoder::OusterDecoder(OusterMetadata metadata) : metadata_(std::move(metadata)) {
  if (metadata_.rows() > PointRows::kMost / 2 ||
      metadata_.columns_per_packet > PacketOutline::kMaxGroups) {
    throw std::invalid_argument("metadata of more rows or columns than any Ouster has");
  }
  constexpr double kDegree = std::numbers::pi / 180;
  for (std::size_t row = 0; row < metadata_.rows(); ++row) {
    const double altitude = metadata_.altitude_deg[row] * kDegree;
    const double azimuth = -metadata_.azimuth_deg[row] * kDegree;
    beams_.push_back({static_cast<float>(std::cos(altitude) * std::cos(azimuth)),
                      static_cast<float>(std::cos(altitude) * std::sin(azimuth)),
                      static_cast<float>(std::sin(altitude))});
  }
  for (std::size_t column = 0; column < metadata_.columns; ++column) {
    const double angle = 2 * std::numbers::pi *
                         (1 - static_cast<double>(column) / static_cast<double>(metadata_.columns));
    turns_.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))});
  }
  origin_m_ = static_cast<float>(metadata_.origin_to_beam_mm * 1e-3);
  height_m_ = static_cast<float>(metadata_.beam_height_mm * 1e-3);
  reach_m_ = std::hypot(origin_m_, height_m_);
  for (std::size_t i = 0; i < T_sensor_lidar_.size(); ++i) {
    T_sensor_lidar_[i] = static_cast<float>(metadata_.lidar_to_sensor[i] * (i % 4 == 3 ? 1e-3 : 1));
  }
}

std::size_t OusterDecoder::column_bytes() const {
  const OusterLayout layout = layout_of(metadata_.profile);
  return layout.column_header + metadata_.rows() * layout.pixel + layout.column_footer;
}

const std::uint8_t* OusterDecoder::column_at(Bytes packet, std::size_t column) const {
  return packet.data() + layout_of(metadata_.profile).packet_header + column * column_bytes();
}

bool OusterDecoder::is_valid(const std::uint8_t* column) const {
  if (metadata_.profile != OusterProfile::kLegacy) return (column[kStatusAt] & 1) != 0;
  return u32_at(column + column_bytes() - 4) == 0xFFFFFFFFU;
}

PacketKind OusterDecoder::outline(Bytes packet, PacketOutline& outline) {
  if (packet.size() != ouster_packet_bytes(metadata_)) return PacketKind::kOther;
  const bool is_legacy = metadata_.profile == OusterProfile::kLegacy;
  outline.groups = metadata_.columns_per_packet;
  outline.is_dual = layout_of(metadata_.profile).second_at != 0;
  outline.rate = 0;
  outline.has_frame = true;
  outline.frame =
      is_legacy ? u16_at(column_at(packet, 0) + kLegacyFrameAt) : u16_at(packet.data() + kFrameAt);
  bool has_time = false;
  for (std::size_t group = 0; group < outline.groups; ++group) {
    const std::uint8_t* column = column_at(packet, group);
    // A column that was not measured may hold no stamp.
    outline.begin_ns[group] = group == 0 ? 0 : outline.begin_ns[group - 1];
    const std::uint32_t id = u16_at(column + kMeasurementAt);
    outline.azimuth[group] =
        static_cast<std::int32_t>(id * static_cast<std::uint64_t>(PacketOutline::kTurn) /
                                  metadata_.columns % PacketOutline::kTurn);
    if (!is_valid(column)) continue;
    if (id >= metadata_.columns) return PacketKind::kDamaged;
    const auto ns = static_cast<std::int64_t>(u64_at(column + kTimestampAt));
    if (ns < 0) return PacketKind::kDamaged;  // which has no difference to the others
    if (!has_time) outline.sensor_ns = ns;
    has_time = true;
    const std::int64_t after = ns - outline.sensor_ns;
    if (after < -1'000'000'000 || after > 1'000'000'000) return PacketKind::kDamaged;
    outline.begin_ns[group] = static_cast<std::int32_t>(after);
  }
  return has_time ? PacketKind::kData : PacketKind::kOther;
}

ReturnCounts OusterDecoder::append(Bytes packet, const PacketOutline& outline, std::size_t first,
                                   std::size_t last, double zero_s,
                                   sensors::LidarScan& scan) const {
  const OusterLayout layout = layout_of(metadata_.profile);
  const auto& T = T_sensor_lidar_;
  ReturnCounts counts;
  PointRows rows(scan);
  for (std::size_t group = first; group < last; ++group) {
    const std::uint8_t* column = column_at(packet, group);
    if (!is_valid(column)) continue;
    const Turn turn = turns_[u16_at(column + kMeasurementAt)];
    const auto time = static_cast<float>(zero_s + outline.begin_ns[group] * 1e-9);
    const std::uint8_t* pixel = column + layout.column_header;
    // Metadata have 512 rows at most.
    rows.reserve(metadata_.rows() * (outline.is_dual ? 2 : 1));
    std::size_t n = 0;
    const auto put = [&](std::size_t row, std::uint32_t range_mm, std::uint32_t reflectivity) {
      const float length = static_cast<float>(static_cast<int>(range_mm)) * 1e-3F - reach_m_;
      const Beam& beam = beams_[row];
      const float ahead = length * beam.x + origin_m_;
      const float left = length * beam.y;
      const float x = ahead * turn.cos - left * turn.sin;
      const float y = ahead * turn.sin + left * turn.cos;
      const float z = length * beam.z + height_m_;
      rows.x()[n] = T[0] * x + T[1] * y + T[2] * z + T[3];
      rows.y()[n] = T[4] * x + T[5] * y + T[6] * z + T[7];
      rows.z()[n] = T[8] * x + T[9] * y + T[10] * z + T[11];
      rows.intensity()[n] = static_cast<float>(static_cast<int>(reflectivity));
      rows.time()[n] = time;
      rows.ring()[n] = static_cast<std::uint16_t>(row);
      ++n;
    };
    for (std::size_t row = 0; row < metadata_.rows(); ++row, pixel += layout.pixel) {
      const std::uint32_t range = range_at(pixel, layout);
      if (range != 0) {
        ++counts.returns;
        put(row, range, pixel[layout.reflectivity_at]);
      }
      if (layout.second_at == 0) continue;
      const std::uint32_t second = range_at(pixel + layout.second_at, layout);
      if (second == 0) continue;
      ++counts.returns;
      if (second == range) {
        ++counts.repeated;
      } else {
        put(row, second, pixel[layout.second_reflectivity_at]);
      }
    }
    counts.points += n;
    rows.take(n);
  }
  return counts;
}

}  // namespace traverse::packets
