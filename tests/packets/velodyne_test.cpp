#include "traverse/packets/velodyne.hpp"

#include <cmath>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "packets/made_velodyne_packet.hpp"

namespace traverse::packets {
namespace {

using testing::MadeVelodynePacket;

constexpr double kDegree = std::numbers::pi / 180;

std::vector<VelodyneLaser> level_lasers(std::size_t count) {
  return std::vector<VelodyneLaser>(count);
}

sensors::LidarScan decoded(const VelodyneDecoder& decoder, const MadeVelodynePacket& packet,
                           std::uint32_t zero_us = 0) {
  sensors::LidarScan scan;
  decoder.append(packet.bytes(), zero_us, scan);
  sensors::check_consistent(scan);
  return scan;
}

double azimuth_deg(const sensors::LidarScan& scan, std::size_t i) {
  return -std::atan2(scan.y[i], scan.x[i]) / kDegree;
}

TEST(Velodyne, EveryReturnIsAPoint) {
  MadeVelodynePacket packet(10, 0.4, 0);
  packet.fill(20);
  packet.set_return(3, 5, 0, 0);  // no return
  EXPECT_EQ(velodyne_returns(packet.bytes(), VelodyneModel::kVlp16), 12U * 32 - 1);
  for (const auto& [model, lasers] :
       {std::pair(VelodyneModel::kVlp16, 16), std::pair(VelodyneModel::kHdl32e, 32),
        std::pair(VelodyneModel::kHdl64e, 64)}) {
    const VelodyneDecoder decoder(model, level_lasers(static_cast<std::size_t>(lasers)));
    EXPECT_EQ(decoded(decoder, packet).size(), 12U * 32 - 1) << lasers;
  }
}

TEST(Velodyne, EachFiringHasItsOwnTimeAndAzimuth) {
  // 10 turns a second: 3600 degrees a second, 0.398 from block to block of a VLP-16.
  MadeVelodynePacket packet(10, 0.398, 1000);
  packet.fill(20);
  const VelodyneDecoder decoder(VelodyneModel::kVlp16, level_lasers(16));
  const auto scan = decoded(decoder, packet, 400);
  for (const std::size_t block : {0U, 4U, 11U}) {
    for (const std::size_t k : {0U, 3U, 15U, 16U, 31U}) {
      const std::size_t i = 32 * block + k;
      const double into_us =
          55.296 * static_cast<double>(k / 16) + 2.304 * static_cast<double>(k % 16);
      const double us = 600 + 110.592 * static_cast<double>(block) + into_us;
      EXPECT_NEAR(scan.time[i], us * 1e-6, 1e-9) << i;
      EXPECT_EQ(scan.ring[i], k % 16);
      EXPECT_NEAR(azimuth_deg(scan, i), 10 + 0.398 * static_cast<double>(block) + 3600e-6 * into_us,
                  0.006)
          << i;
    }
  }
  const std::set<float> times(scan.time.begin(), scan.time.end());
  EXPECT_EQ(times.size(), scan.size());
}

TEST(Velodyne, AzimuthsAreClockwiseFromAheadAndElevationsUpwards) {
  MadeVelodynePacket packet(90, 0, 0);
  packet.set_return(0, 3, 10, 99);
  std::vector<VelodyneLaser> lasers = level_lasers(16);
  lasers[3].elevation = 30 * kDegree;
  const auto scan = decoded(VelodyneDecoder(VelodyneModel::kVlp16, lasers), packet);
  ASSERT_EQ(scan.size(), 1U);
  EXPECT_NEAR(scan.x[0], 0, 1e-5);
  EXPECT_NEAR(scan.y[0], -10 * std::cos(30 * kDegree), 1e-5);
  EXPECT_NEAR(scan.z[0], 5, 1e-5);
  EXPECT_EQ(scan.intensity[0], 99);
}

TEST(Velodyne, CorrectionsOfALaserMoveItsReturns) {
  MadeVelodynePacket packet(0, 0, 0);
  packet.set_return(0, 1, 10, 1);
  std::vector<VelodyneLaser> lasers = level_lasers(64);
  lasers[1] = {0, 0, 0.5, 0.2, 0.03};
  auto scan = decoded(VelodyneDecoder(VelodyneModel::kHdl64e, lasers), packet);
  EXPECT_NEAR(scan.x[0], 10.5, 1e-5);
  EXPECT_NEAR(scan.y[0], 0.03, 1e-5);
  EXPECT_NEAR(scan.z[0], 0.2, 1e-5);
  lasers[1] = {0, 5 * kDegree, 0, 0, 0};
  scan = decoded(VelodyneDecoder(VelodyneModel::kHdl64e, lasers), packet);
  EXPECT_NEAR(azimuth_deg(scan, 0), -5, 1e-4);
}

TEST(Velodyne, LowerBlocksOfAnHdl64eAreItsLasersFrom32On) {
  MadeVelodynePacket packet(0, 0, 0);
  packet.set_flag(1, 0xDDFF);
  packet.set_return(0, 4, 10, 1);
  packet.set_return(1, 4, 10, 1);
  packet.set_return(2, 4, 10, 1);
  const auto scan = decoded(VelodyneDecoder(VelodyneModel::kHdl64e, level_lasers(64)), packet);
  EXPECT_THAT(scan.ring, ::testing::ElementsAre(4, 36, 4));
  EXPECT_THAT(scan.time, ::testing::ElementsAre(0, 0, ::testing::FloatEq(48e-6F)));
}

TEST(Velodyne, TwoReturnsOfOneFiringShareItsTimeAndAreOneWhenTheyAreTheSame) {
  MadeVelodynePacket packet(0, 0, 0, 0x39);
  for (std::size_t block = 0; block < 12; ++block) {
    packet.set_azimuth(block, 0.4 * static_cast<double>(block / 2));
  }
  packet.set_return(4, 2, 10, 1);  // the last
  packet.set_return(5, 2, 8, 2);   // the strongest
  packet.set_return(4, 3, 10, 1);
  packet.set_return(5, 3, 10, 1);
  EXPECT_EQ(velodyne_returns(packet.bytes(), VelodyneModel::kVlp16), 3U);
  const auto scan = decoded(VelodyneDecoder(VelodyneModel::kVlp16, level_lasers(16)), packet);
  ASSERT_EQ(scan.size(), 3U);
  EXPECT_EQ(scan.time[0], scan.time[2]);
  EXPECT_NEAR(scan.time[0], (2 * 110.592 + 2 * 2.304) * 1e-6, 1e-9);
  EXPECT_NEAR(azimuth_deg(scan, 0), 0.8 + 0.4 * 2 * 2.304 / 110.592, 0.003);
}

TEST(Velodyne, AnHourThatEndsBetweenPacketsIsNoJump) {
  MadeVelodynePacket packet(0, 0.4, 100);
  packet.set_return(0, 0, 10, 1);
  const VelodyneDecoder decoder(VelodyneModel::kVlp16, level_lasers(16));
  EXPECT_NEAR(decoded(decoder, packet, 3'599'999'900).time[0], 200e-6, 1e-9);
  MadeVelodynePacket before(0, 0.4, 3'599'999'900);
  before.set_return(0, 0, 10, 1);
  EXPECT_NEAR(decoded(decoder, before, 100).time[0], -200e-6, 1e-9);
}

TEST(Velodyne, ASectorWithoutPacketsIsNoFastTurn) {
  MadeVelodynePacket packet(350, 0.4, 0);
  for (std::size_t block = 6; block < 12; ++block) {
    packet.set_azimuth(block, 90 + 0.4 * static_cast<double>(block));
  }
  packet.fill(20);
  const auto scan = decoded(VelodyneDecoder(VelodyneModel::kVlp16, level_lasers(16)), packet);
  EXPECT_NEAR(azimuth_deg(scan, 5 * 32 + 16), 352.2 - 360, 0.01);
}

TEST(Velodyne, ADamagedPacketGivesNothing) {
  MadeVelodynePacket packet(0, 0.4, 0);
  packet.fill(20);
  packet.set_flag(7, 0x1234);
  EXPECT_FALSE(is_velodyne_data(packet.bytes()));
  EXPECT_TRUE(decoded(VelodyneDecoder(VelodyneModel::kVlp16, level_lasers(16)), packet).empty());
}

TEST(Velodyne, ACalibrationOfAnotherModelIsRefused) {
  EXPECT_THROW(VelodyneDecoder(VelodyneModel::kVlp16, level_lasers(32)), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::packets
