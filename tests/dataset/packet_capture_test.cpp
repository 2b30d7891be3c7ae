#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/open_recording.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

#include "packets/made_capture.hpp"
#include "packets/made_velodyne_packet.hpp"
#include "temporary_folder.hpp"
#include "test_data.hpp"

namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::MadeCapture;
using testing::MadeVelodynePacket;
using testing::TemporaryFolder;

std::unique_ptr<Source> open_capture(const fs::path& file,
                                     std::vector<std::string> statements = {}) {
  OpenOptions options;
  options.share_folder = TRAVERSE_SHARE_DIR;
  options.statements = std::move(statements);
  return open_recording(file, options);
}

struct Contents {
  std::vector<std::shared_ptr<const sensors::LidarScan>> scans;
  std::vector<sensors::ImuSample> imu;
  std::vector<sensors::GnssFix> fixes;
  std::size_t points() const {
    std::size_t sum = 0;
    for (const auto& scan : scans) sum += scan->size();
    return sum;
  }
};

Contents read_all(Source& source) {
  Contents contents;
  while (const auto measurement = source.next()) {
    if (const auto* scan = std::get_if<std::shared_ptr<const sensors::LidarScan>>(&*measurement)) {
      sensors::check_consistent(**scan);
      contents.scans.push_back(*scan);
    }
    if (const auto* sample = std::get_if<sensors::ImuSample>(&*measurement)) {
      contents.imu.push_back(*sample);
    }
    if (const auto* fix = std::get_if<sensors::GnssFix>(&*measurement)) {
      contents.fixes.push_back(*fix);
    }
  }
  return contents;
}

std::string fact(const Source& source, const std::string& name) {
  for (const Fact& fact : source.info().facts) {
    if (fact.name == name) return fact.value;
  }
  return "";
}

/// A VLP-16 that turns ten times a second, from the beginning of an hour on.
void add_turns(MadeCapture& capture, int packets, std::uint16_t port, double distance_m) {
  constexpr std::int64_t kHour_ns = 1'699'999'200'000'000'000;
  for (int n = 0; n < packets; ++n) {
    const double us = 1327.104 * n;
    MadeVelodynePacket packet(std::fmod(us * 3600e-6, 360), 0.398, static_cast<std::uint32_t>(us));
    packet.fill(distance_m);
    const auto bytes = packet.bytes();
    capture.add_datagram({bytes.begin(), bytes.end()}, kHour_ns + std::llround(us * 1e3) + 700'000,
                         port);
  }
}

TEST(PacketCapture, GivesWholeTurnsOfEachLidarAndCountsTheRest) {
  const TemporaryFolder folder;
  MadeCapture capture;
  add_turns(capture, 250, 2368, 20);
  add_turns(capture, 250, 2369, 30);
  capture.add_datagram({1, 2, 3}, 1'699'999'201'000'000'000);
  capture.write(folder / "two.pcap");
  const auto source = open_capture(folder / "two.pcap");
  EXPECT_EQ(source->info().format, "packet capture");
  ASSERT_EQ(source->info().rig.sensors.size(), 2U);
  EXPECT_EQ(source->info().rig.sensors[1].label, "lidar 2");
  EXPECT_EQ(source->info().rig.sensors[0].lidar->name, "VLP-16");
  const Contents first = read_all(*source);
  // Half a turn, two turns and most of one: they begin behind.
  std::size_t of_first = 0;
  for (const auto& scan : first.scans) of_first += scan->sensor == "lidar";
  EXPECT_EQ(of_first, 4U);
  EXPECT_EQ(source->skipped().by_reason().at("packet that is no data of its lidar").count, 1U);
  EXPECT_THAT(fact(*source, "packets of the lidar"), HasSubstr("250 of returns; 96000 returns"));
  source->rewind();
  const Contents again = read_all(*source);
  ASSERT_EQ(again.scans.size(), first.scans.size());
  for (std::size_t i = 0; i < first.scans.size(); ++i) {
    EXPECT_EQ(again.scans[i]->x, first.scans[i]->x);
    EXPECT_EQ(again.scans[i]->stamp, first.scans[i]->stamp);
  }
}

TEST(PacketCapture, OneWithoutALidarIsRefused) {
  const TemporaryFolder folder;
  MadeCapture capture;
  capture.add_datagram(std::vector<std::uint8_t>(100, 1), 1);
  capture.write(folder / "other.pcap");
  try {
    open_capture(folder / "other.pcap");
    FAIL() << "opened";
  } catch (const files::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("1 frames with 1 datagrams of UDP"));
  }
}

TEST(PacketCapture, AnOusterWithoutItsMetadataSaysWhatIsMissing) {
  const TemporaryFolder folder;
  MadeCapture capture;
  std::vector<std::uint8_t> packet(32 + 16 * (12 + 64 * 12) + 32, 0);
  packet[0] = 1;
  capture.add_datagram(packet, 1, 7502);
  capture.write(folder / "os.pcap");
  try {
    open_capture(folder / "os.pcap");
    FAIL() << "opened";
  } catch (const files::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("lidar.metadata=FILE"));
  }
  files::write_text(folder / "os.json",
                    R"({"beam_altitude_angles": [1], "beam_azimuth_angles": []})");
  EXPECT_THROW(open_capture(folder / "os.pcap"), files::InputError);
}

fs::path recorded(const char* file) { return testing::test_data() / "recordings" / file; }
constexpr const char* kNoRecordings =
    "recorded captures are not there: the folder that TRAVERSE_TEST_DATA names has them as "
    "recordings";

TEST(PacketCapture, OfAnOusterGivesItsTurnsAndItsImu) {
  const fs::path file = recorded("ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap");
  if (!fs::exists(file)) GTEST_SKIP() << kNoRecordings;
  const auto source = open_capture(
      file,
      {"reference.file=OS-1-128_v2.3.0_1024x10_lb_n3_poses_kitti.txt", "reference.format=kitti"});
  EXPECT_EQ(source->info().rig.first(sensors::SensorKind::kLidar)->lidar->rings, 128);
  ASSERT_TRUE(source->reference());
  const Contents contents = read_all(*source);
  ASSERT_EQ(contents.scans.size(), 3U);
  EXPECT_EQ(contents.imu.size(), 30U);
  double force = 0;
  for (const auto& sample : contents.imu) force += sample.specific_force.norm() / 30;
  EXPECT_NEAR(force, 10.66, 0.01);  // on a vehicle that drives
  for (const auto& scan : contents.scans) {
    EXPECT_GT(scan->size(), 60000U);
    EXPECT_NEAR(scan->time.back(), 0.0999, 0.001);
  }
  EXPECT_NEAR(geometry::seconds_between(contents.scans[0]->stamp, contents.scans[2]->stamp), 0.2,
              0.001);
  EXPECT_TRUE(source->skipped().empty());
}

TEST(PacketCapture, OfAVelodyneGivesFixesOfItsPositionPackets) {
  const fs::path file = recorded("mrpt/sample_velodyne_vlp16_gps.pcap");
  if (!fs::exists(file)) GTEST_SKIP() << kNoRecordings;
  const auto source = open_capture(file);
  const Contents contents = read_all(*source);
  // Less than half a turn at the beginning, three turns and most of one.
  ASSERT_EQ(contents.scans.size(), 4U);
  EXPECT_EQ(fact(*source, "packets of the lidar"),
            "293 of returns; 73486 returns, 0 of them a second time at the same distance, "
            "73486 points");
  EXPECT_EQ(contents.points() + 3868, 73486U);
  EXPECT_EQ(fact(*source, "points of parts of a turn"), "3868");
  ASSERT_EQ(contents.fixes.size(), 1U);  // the sentence is the same in all of them
  EXPECT_NEAR(contents.fixes[0].latitude_deg, 36.829131, 1e-6);
  EXPECT_NEAR(contents.fixes[0].longitude_deg, -2.407572, 1e-6);
  EXPECT_EQ(contents.fixes[0].stamp, geometry::Stamp{1'453'364'282'000'000'000});
  EXPECT_THAT(fact(*source, "clock of the lidar against its receiver"), HasSubstr("0.342 s"));
}

}  // namespace
}  // namespace traverse::dataset
