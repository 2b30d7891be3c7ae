#include <cstdint>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "traverse/packets/packet_lidars.hpp"

namespace traverse::packets {
namespace {

constexpr std::size_t kOusterRows = 8;
constexpr std::size_t kOusterColumns = 4;

OusterMetadata small_legacy_ouster() {
  OusterMetadata metadata;
  metadata.product = "OS-0";
  metadata.lidar_mode = "512x10";
  metadata.columns = 512;
  metadata.columns_per_packet = kOusterColumns;
  metadata.altitude_deg.assign(kOusterRows, 1);
  metadata.azimuth_deg.assign(kOusterRows, 0);
  return metadata;
}

/// Of profile LEGACY: each column time, number, frame, encoder; pixels of twelve bytes; a status.
std::vector<std::uint8_t> packet_of_columns(const std::vector<std::uint64_t>& times) {
  constexpr std::size_t kColumnBytes = 16 + 12 * kOusterRows + 4;
  std::vector<std::uint8_t> packet(times.size() * kColumnBytes, 0);
  for (std::size_t i = 0; i < times.size(); ++i) {
    std::uint8_t* column = packet.data() + i * kColumnBytes;
    std::memcpy(column, &times[i], sizeof times[i]);
    column[8] = static_cast<std::uint8_t>(i);
    std::memset(column + kColumnBytes - 4, 0xFF, 4);
  }
  return packet;
}

TEST(DamagedOuster, ATimeThatNoClockTellsCostsItsPacket) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  constexpr std::uint64_t kBeyond = 0x8807060504030201;  // negative, if it had a sign
  PacketLidars lidars(small_legacy_ouster());
  for (const auto& times : {std::vector<std::uint64_t>{kSecond, kSecond, kSecond, kSecond},
                            {kSecond, kBeyond, kSecond, kSecond},
                            {kBeyond, kSecond, kSecond, kSecond},
                            {std::uint64_t{INT64_MAX}, 0, kSecond, kSecond}}) {
    lidars.add("7502", packet_of_columns(times), geometry::Stamp{1'700'000'000'000'000'000},
               [](auto&&) {});
  }
  ASSERT_EQ(lidars.lidars().size(), 1U);
  EXPECT_EQ(lidars.counts(0).data, 1U);
  EXPECT_EQ(lidars.counts(0).damaged, 3U);
}

}  // namespace
}  // namespace traverse::packets
