#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/open_recording.hpp"
#include "traverse/packets/udp_capture.hpp"

#include "bags/bag_writers.hpp"
#include "dataset/made_recordings.hpp"
#include "packets/made_capture.hpp"
#include "packets/made_velodyne_packet.hpp"
#include "temporary_folder.hpp"
#include "test_data.hpp"

namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using namespace traverse::testing;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int64_t kHour = 1'699'999'200'000'000'000;
constexpr std::size_t kReturnsAPacket = 384;

/// A VLP-16 that turns ten times a second, from the beginning of an hour on.
std::vector<MadePacket> turns_of_a_vlp16(int packets) {
  std::vector<MadePacket> made;
  for (int n = 0; n < packets; ++n) {
    const double us = 1327.104 * n;
    MadeVelodynePacket packet(std::fmod(us * 3600e-6, 360), 0.398, static_cast<std::uint32_t>(us));
    packet.fill(10 + 0.01 * n);
    const auto bytes = packet.bytes();
    made.push_back({kHour + std::llround(us * 1e3) + 700'000, {bytes.begin(), bytes.end()}});
  }
  return made;
}

/// As a driver stores them: `a_message` packets each, when the last has come.
std::vector<MadeMessage> messages_of(const std::vector<MadePacket>& packets,
                                     const std::string& type, Wire wire, std::size_t a_message) {
  if (type.ends_with("/PacketMsg")) a_message = 1;
  std::vector<MadeMessage> messages;
  for (std::size_t i = 0; i < packets.size(); i += a_message) {
    const std::size_t last = std::min(i + a_message, packets.size());
    const std::vector<MadePacket> some(packets.begin() + static_cast<std::ptrdiff_t>(i),
                                       packets.begin() + static_cast<std::ptrdiff_t>(last));
    messages.push_back({"/packets", type, some.back().ns,
                        packets_message(type, wire, some.front().ns, "lidar", some)});
  }
  return messages;
}

/// The numbers of the facts about packets; all returns and points are there or counted.
struct Accounts {
  std::size_t packets = 0;
  std::size_t returns = 0;
  std::size_t repeated = 0;
  std::size_t points = 0;
  std::size_t of_parts = 0;
};
Accounts accounts_of(const Source& source, const std::string& topic) {
  const std::string told = fact_value(source, "packets of " + topic);
  std::vector<std::size_t> numbers;
  const std::regex number("[0-9]+");
  for (std::sregex_iterator i(told.begin(), told.end(), number), end; i != end; ++i) {
    numbers.push_back(std::stoul(i->str()));
  }
  if (numbers.size() != 4) throw std::runtime_error("no accounts of packets: " + told);
  const std::string parts = fact_value(source, "points of parts of a turn");
  return {numbers[0], numbers[1], numbers[2], numbers[3], parts.empty() ? 0 : std::stoul(parts)};
}

std::size_t points_in(const std::vector<ScanPtr>& scans) {
  return std::accumulate(scans.begin(), scans.end(), std::size_t{0},
                         [](std::size_t sum, const ScanPtr& scan) { return sum + scan->size(); });
}

void expect_equal_scans(const std::vector<ScanPtr>& scans, const std::vector<ScanPtr>& expected) {
  ASSERT_EQ(scans.size(), expected.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(scans[i]->stamp, expected[i]->stamp);
    EXPECT_EQ(scans[i]->x, expected[i]->x);
    EXPECT_EQ(scans[i]->z, expected[i]->z);
    EXPECT_EQ(scans[i]->ring, expected[i]->ring);
    EXPECT_EQ(scans[i]->time, expected[i]->time);
  }
}

TEST(PacketBags, OfEveryTypeAndKindGiveTheScansOfACaptureOfThem) {
  const TemporaryFolder folder;
  const auto packets = turns_of_a_vlp16(250);
  MadeCapture capture;
  for (const MadePacket& packet : packets) {
    capture.add_datagram({packet.bytes.begin(), packet.bytes.end()}, packet.ns);
  }
  capture.write(folder / "a.pcap");
  const auto expected = read_scans(*open(folder / "a.pcap"));
  ASSERT_EQ(expected.size(), 4U);
  // A decoder goes by the bytes, so that every type may hold those of a Velodyne.
  for (const std::string type :
       {"velodyne_msgs/VelodyneScan", "pandar_msgs/PandarScan", "hesai_lidar/PandarScan",
        "nebula_msgs/NebulaPackets", "ouster_ros/PacketMsg", "ouster_sensor_msgs/PacketMsg"}) {
    for (const std::string name : {"a.bag", "a.mcap", "b.mcap", "a"}) {
      SCOPED_TRACE(type + " in " + name);
      const fs::path bag = folder / name;
      fs::remove_all(bag);
      if (name == "a.bag") {
        write_ros1_bag(bag, messages_of(packets, type, Wire::kRos1, 76));
      } else if (name == "a.mcap") {
        write_mcap(bag, messages_of(packets, type, Wire::kCdr, 76));
      } else if (name == "b.mcap") {
        write_mcap(bag, messages_of(packets, type, Wire::kCdrBigEndian, 7), {},
                   Wire::kCdrBigEndian);
      } else {  // without definitions: they are built in
        write_ros2_bag(bag, messages_of(packets, type, Wire::kCdr, 76), {});
      }
      const auto source = open(bag);
      EXPECT_EQ(source->info().topics.at(0).use, "lidar");
      EXPECT_EQ(source->info().rig.sensors.at(0).label, "/packets");
      EXPECT_EQ(source->info().rig.sensors.at(0).lidar->name, "VLP-16");
      EXPECT_EQ(fact_value(*source, "clock"), "the lidar's");
      const auto scans = read_scans(*source);
      expect_equal_scans(scans, expected);
      for (const ScanPtr& scan : scans) EXPECT_EQ(scan->sensor, "/packets");
      const Accounts accounts = accounts_of(*source, "/packets");
      EXPECT_EQ(accounts.packets, 250U);
      EXPECT_EQ(accounts.returns, 250 * kReturnsAPacket);
      EXPECT_EQ(points_in(scans) + accounts.of_parts, accounts.returns);
      source->rewind();
      expect_equal_scans(read_scans(*source), expected);
    }
  }
}

TEST(PacketBags, PacketsThatCannotBeUsedAreCounted) {
  const TemporaryFolder folder;
  const std::string type = "pandar_msgs/PandarScan";
  auto messages = messages_of(turns_of_a_vlp16(250), type, Wire::kRos1, 50);
  // Says that its last packet were larger than its room.
  messages[2].bytes[messages[2].bytes.size() - 1] = '\x7f';
  messages[3].bytes.resize(messages[3].bytes.size() - 1);
  messages.push_back({"/packets", type, kHour + 400'000'000,
                      packets_message(type, Wire::kRos1, kHour, "lidar", {})});
  messages.push_back({"/packets", type, kHour + 400'000'001,
                      packets_message(type, Wire::kRos1, kHour, "lidar", {{kHour, "abc"}})});
  write_ros1_bag(folder / "a.bag", messages);
  const auto source = open(folder / "a.bag");
  const auto scans = read_scans(*source);
  const Accounts accounts = accounts_of(*source, "/packets");
  // Of the third message all but the last packet were given before.
  EXPECT_EQ(accounts.packets, 199U);
  EXPECT_EQ(points_in(scans) + accounts.of_parts, accounts.returns);
  const auto& skipped = source->skipped().by_reason();
  EXPECT_EQ(skipped.count("a message without packets"), 1U);
  EXPECT_EQ(skipped.count("packet that is no data of its lidar"), 1U);
  EXPECT_THAT(skipped_in(*source),
              ::testing::Contains(HasSubstr("a packet of 2130707638 bytes in 1500 bytes")));
}

TEST(PacketBags, ACloudWithPointTimesIsTakenBeforePackets) {
  const TemporaryFolder folder;
  for (const bool has_times : {false, true}) {
    auto messages =
        messages_of(turns_of_a_vlp16(150), "velodyne_msgs/VelodyneScan", Wire::kRos1, 76);
    for (int i = 0; i < 3; ++i) {
      CloudMessage cloud;
      cloud.width = 8;
      cloud.point_step = 20;
      cloud.row_step = 160;
      cloud.fields = {{"x", 0}, {"y", 4}, {"z", 8}, {"ring", 12, 4}};
      if (has_times) cloud.fields.push_back({"time", 16});
      for (int k = 0; k < 8; ++k) {
        const float xyz[3] = {1.F + static_cast<float>(k), 2, 3};
        const std::uint32_t ring = static_cast<std::uint32_t>(k);
        const float time = 0.01F * static_cast<float>(k);
        cloud.data.append(reinterpret_cast<const char*>(xyz), sizeof xyz);
        cloud.data.append(reinterpret_cast<const char*>(&ring), sizeof ring);
        cloud.data.append(reinterpret_cast<const char*>(&time), sizeof time);
      }
      const std::int64_t ns = kHour + i * 100'000'000;
      messages.push_back({"/points", "sensor_msgs/PointCloud2", ns,
                          cloud_message(Wire::kRos1, ns, "lidar", cloud)});
    }
    write_ros1_bag(folder / "a.bag", messages);
    EXPECT_EQ(fact_value(*open(folder / "a.bag"), "lidar"), has_times ? "/points" : "/packets");
    const auto source = open(folder / "a.bag", {"lidar.topic=/packets"});
    EXPECT_EQ(points_in(read_scans(*source)) + accounts_of(*source, "/packets").of_parts,
              150 * kReturnsAPacket);
  }
}

TEST(PacketBags, OfTwoLidarsAreUsedAsOneWhereStated) {
  const TemporaryFolder folder;
  auto messages = messages_of(turns_of_a_vlp16(300), "velodyne_msgs/VelodyneScan", Wire::kRos1, 76);
  const std::size_t count = messages.size();
  for (std::size_t i = 0; i < count; ++i) {
    messages.push_back(messages[i]);
    messages.back().topic = "/packets_behind";
  }
  write_ros1_bag(folder / "a.bag", messages);
  const auto points_in = [](const std::vector<ScanPtr>& scans) {
    std::size_t points = 0;
    for (const ScanPtr& scan : scans) points += scan->size();
    return points;
  };
  const auto one = open(folder / "a.bag", {"lidars=/packets"});
  const std::size_t points = points_in(read_scans(*one));
  EXPECT_GT(points, 0U);
  const auto both = open(folder / "a.bag", {"lidars=/packets,/packets_behind"});
  EXPECT_EQ(points_in(read_scans(*both)), 2 * points);
  EXPECT_EQ(accounts_of(*both, "/packets_behind").points, accounts_of(*both, "/packets").points);
  EXPECT_EQ(both->info().rig.find("/packets + /packets_behind")->lidar->rings, 32);
}

TEST(PacketBags, OfALidarThatIsNotKnownAreRefusedByWhatIsMissing) {
  const TemporaryFolder folder;
  std::string ouster(32 + 16 * (12 + 64 * 12) + 32, '\0');
  ouster[0] = '\1';
  const std::string type = "ouster_sensor_msgs/PacketMsg";
  write_mcap(folder / "os.mcap", messages_of({{kHour, ouster}}, type, Wire::kCdr, 1));
  EXPECT_THAT(opening_error(folder / "os.mcap"), HasSubstr("lidar.metadata=FILE"));
  write_mcap(folder / "other.mcap", messages_of({{kHour, "abc"}}, type, Wire::kCdr, 1));
  EXPECT_THAT(opening_error(folder / "other.mcap"),
              HasSubstr("1 packets, none of a Velodyne, a Hesai or an Ouster"));
  OpenOptions options = options_with();
  options.wants_measurements = false;
  const auto source = open_recording(folder / "other.mcap", options);
  EXPECT_THAT(source->info().topics.at(0).why, HasSubstr("none of a Velodyne"));
  EXPECT_FALSE(source->next());
}

TEST(PacketBags, OfAnOusterGiveWhatItsCaptureGives) {
  const fs::path data = test_data() / "recordings/ouster";
  const fs::path capture = data / "OS-1-128_v2.3.0_1024x10_lb_n3.pcap";
  const fs::path metadata = data / "OS-1-128_v2.3.0_1024x10.json";
  if (!fs::exists(capture)) GTEST_SKIP() << "no recordings where TRAVERSE_TEST_DATA says";
  const auto of_capture = read_all(*open(capture));
  std::vector<MadeMessage> messages;
  packets::UdpCapture datagrams(capture);
  while (const auto datagram = datagrams.next()) {
    constexpr std::size_t kImuBytes = 48;
    const std::string type = "ouster_sensor_msgs/PacketMsg";
    const std::string bytes(datagram->payload.begin(), datagram->payload.end());
    const std::int64_t ns = datagram->arrival.nanoseconds;
    messages.push_back({bytes.size() == kImuBytes ? "/os/imu_packets" : "/os/lidar_packets", type,
                        ns, packets_message(type, Wire::kCdr, ns, "", {{ns, bytes}})});
  }
  const TemporaryFolder folder;
  write_mcap(folder / "stated.mcap", messages);
  std::ifstream in(metadata, std::ios::binary);
  const std::string json{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  messages.push_back({"/os/metadata", "std_msgs/String", messages.back().log_time_ns,
                      MessageWriter(Wire::kCdr).text(json).take()});
  write_mcap(folder / "topic.mcap", messages);
  for (const bool is_stated : {false, true}) {
    const auto source = is_stated
                            ? open(folder / "stated.mcap", {"lidar.metadata=" + metadata.string()})
                            : open(folder / "topic.mcap");
    const auto measurements = read_all(*source);
    EXPECT_THAT(skipped_in(*source), IsEmpty());
    ASSERT_EQ(measurements.size(), of_capture.size());
    expect_equal_scans(scans_in(measurements), scans_in(of_capture));
    const auto* imu = source->info().rig.first(sensors::SensorKind::kImu);
    ASSERT_NE(imu, nullptr);
    EXPECT_EQ(imu->label, "/os/imu_packets");
    EXPECT_TRUE(
        imu->T_body_sensor.translation.isApprox(Eigen::Vector3d(6.253e-3, -11.775e-3, 7.645e-3)));
    const Accounts accounts = accounts_of(*source, "/os/lidar_packets");
    EXPECT_EQ(points_in(scans_in(measurements)) + accounts.of_parts,
              accounts.returns - accounts.repeated);
  }
}

TEST(PacketBags, OfDriversGiveAPointForEachReturn) {
  const fs::path data = test_data() / "recordings/ros2_packets";
  if (!fs::exists(data)) GTEST_SKIP() << "no recordings where TRAVERSE_TEST_DATA says";
  std::size_t bags = 0;
  for (const auto& sensor : fs::directory_iterator(data)) {
    if (!sensor.is_directory()) continue;
    for (const auto& bag : fs::directory_iterator(sensor)) {
      if (!bag.is_directory()) continue;
      SCOPED_TRACE(bag.path().string());
      ++bags;
      const auto source = open(bag);
      ASSERT_EQ(source->info().topics.size(), 1U);
      EXPECT_EQ(source->info().topics[0].use, "lidar");
      const auto scans = read_scans(*source);
      EXPECT_GE(scans.size(), 3U);
      EXPECT_LE(scans.size(), 6U);
      const Accounts accounts = accounts_of(*source, source->info().topics[0].topic);
      EXPECT_GT(accounts.returns, 60'000U);
      EXPECT_EQ(accounts.points, accounts.returns - accounts.repeated);
      EXPECT_EQ(points_in(scans) + accounts.of_parts, accounts.points);
    }
  }
  EXPECT_EQ(bags, 5U);
}

}  // namespace
}  // namespace traverse::dataset
