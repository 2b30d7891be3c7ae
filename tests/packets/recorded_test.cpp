// Packets of real sensors against clouds that another decoder made of them (tier4/nebula).

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>
#include <unordered_map>
#include <vector>

#include <gtest/gtest.h>

#include "traverse/packets/packet_sweeps.hpp"
#include "traverse/packets/velodyne.hpp"

#include "hesai.hpp"
#include "packets/recorded_packets.hpp"
#include "test_data.hpp"

namespace traverse::packets {
namespace {

namespace fs = std::filesystem;
using testing::RecordedPacket;

/// The true clouds of Velodynes are not true in three things, which are done here as the truth does
/// them: the last block of a packet is not turned while its lasers fire; those of a VLP-32C are
/// turned as if they fired one by one, and not two at a time; and second returns of a VLP-16 have
/// the azimuth of the next firing's first laser. Where it is right, ours is compared as it is.
struct Recorded {
  const char* folder;
  const char* model;
  double turn_of_truth = 1;  ///< by the turn while a block's lasers fire
  bool is_velodyne = false;
};

/// Finds points by cells of a centimetre.
class PointFinder {
 public:
  explicit PointFinder(const sensors::LidarScan& scan) : scan_(scan) {
    for (std::size_t i = 0; i < scan.size(); ++i) {
      cells_.emplace(key(cell(scan.x[i]), cell(scan.y[i]), cell(scan.z[i])), i);
    }
  }
  double nearest_m(const std::array<float, 3>& p) const {
    double least = 1;
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          const auto [from, to] =
              cells_.equal_range(key(cell(p[0]) + dx, cell(p[1]) + dy, cell(p[2]) + dz));
          for (auto found = from; found != to; ++found) {
            const std::size_t i = found->second;
            least = std::min(least, std::hypot(double{scan_.x[i]} - double{p[0]},
                                               double{scan_.y[i]} - double{p[1]},
                                               double{scan_.z[i]} - double{p[2]}));
          }
        }
      }
    }
    return least;
  }

 private:
  static int cell(float value) { return static_cast<int>(std::floor(value * 100)); }
  static std::uint64_t key(int x, int y, int z) {
    const auto part = [](int v) { return static_cast<std::uint64_t>(v + (1 << 20)) & 0x1FFFFF; };
    return part(x) << 42 | part(y) << 21 | part(z);
  }
  const sensors::LidarScan& scan_;
  std::unordered_multimap<std::uint64_t, std::size_t> cells_;
};

std::unique_ptr<PacketDecoder> decoder_for(Bytes packet, std::string& name) {
  if (const auto model = hesai_model(packet)) {
    name = name_of(*model);
    return std::make_unique<HesaiDecoder>(*model, hesai_lasers(*model));
  }
  if (packet.size() != kVelodynePacketBytes) return nullptr;
  const auto model = velodyne_model(VelodynePacket(packet.data(), kVelodynePacketBytes));
  if (!model) return nullptr;
  name = name_of(*model);
  auto lasers = velodyne_lasers(*model);
  if (*model == VelodyneModel::kVlp32c) {  // at ten turns a second
    for (std::size_t i = 1; i < lasers.size(); i += 2) {
      lasers[i].azimuth_correction -= 2.304e-6 * 20 * std::numbers::pi;
    }
  }
  return std::make_unique<VelodyneDecoder>(*model, lasers);
}

/// With the azimuth of the next firing at second returns.
std::vector<std::uint8_t> with_next_azimuths(std::vector<std::uint8_t> packet) {
  for (std::size_t block = 1; block < 11; block += 2) {
    packet[100 * block + 2] = packet[100 * block + 102];
    packet[100 * block + 3] = packet[100 * block + 103];
  }
  return packet;
}

class RecordedPackets : public ::testing::TestWithParam<Recorded> {};

TEST_P(RecordedPackets, EachTruePointIsThere) {
  const fs::path folder = testing::test_data() / "recordings/ros2_packets" / GetParam().folder;
  if (!fs::exists(folder)) {
    GTEST_SKIP() << "recorded packets are not there: the folder that TRAVERSE_TEST_DATA names has "
                    "them as recordings/ros2_packets";
  }
  fs::path bag;
  fs::path truth;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".db3") bag = entry.path();
    if (entry.path().extension() == ".pcd") truth = entry.path();
  }
  const auto packets = testing::packets_of_bag(bag);
  const auto points = testing::points_of_pcd(truth);
  ASSERT_FALSE(packets.empty());
  ASSERT_FALSE(points.empty());
  std::string name;
  const auto decoder = decoder_for(packets.front().bytes, name);
  ASSERT_TRUE(decoder);
  EXPECT_EQ(name, GetParam().model);

  // The truth's name is when its last packet was recorded; where its turn was cut is not told.
  const std::int64_t end_ns = std::stoll(truth.stem().string());
  sensors::LidarScan scan;
  ReturnCounts counts;
  for (const RecordedPacket& packet : packets) {
    PacketOutline outline;
    ASSERT_EQ(decoder->outline(packet.bytes, outline), PacketKind::kData);
    const std::int64_t ns = packet.arrival.nanoseconds;
    if (ns < end_ns - 210'000'000 || ns > end_ns + 2'000'000) continue;
    if (!GetParam().is_velodyne) {
      counts += decoder->append(packet.bytes, outline, 0, outline.groups, 0, scan);
      continue;
    }
    // From block to block, and not by the mean of a packet.
    for (std::size_t group = 0; group < outline.groups; ++group) {
      outline.rate = 0;
      if (group + 1 < outline.groups) {
        const int units = (outline.azimuth[group + 1] - outline.azimuth[group] + 36000) % 36000;
        const double us = (outline.begin_ns[group + 1] - outline.begin_ns[group]) * 1e-3;
        outline.rate = GetParam().turn_of_truth * units * std::numbers::pi / 18000 / us;
      }
      counts += decoder->append(packet.bytes, outline, group, group + 1, 0, scan);
    }
    if (!outline.is_dual) continue;
    counts += decoder->append(packet.bytes, outline, 0, outline.groups, 0, scan);
    counts +=
        decoder->append(with_next_azimuths(packet.bytes), outline, 0, outline.groups, 0, scan);
  }
  EXPECT_EQ(counts.points, scan.size());
  EXPECT_EQ(counts.returns, counts.points + counts.repeated);
  const PointFinder finder(scan);
  std::size_t missing = 0;
  double most = 0;
  double sum = 0;
  for (const auto& point : points) {
    const double apart = finder.nearest_m(point);
    if (apart > 0.004) {
      if (++missing < 4) {
        ADD_FAILURE() << "no point within 4 mm of " << point[0] << ' ' << point[1] << ' '
                      << point[2] << ", the nearest " << apart;
      }
      continue;
    }
    most = std::max(most, apart);
    sum += apart;
  }
  EXPECT_EQ(missing, 0U) << "of " << points.size();
  RecordProperty("points", std::to_string(points.size()));
  std::printf("%s: %zu true points, %zu decoded, mean %.2f mm, most %.2f mm apart\n", name.c_str(),
              points.size(), scan.size(), 1e3 * sum / static_cast<double>(points.size()),
              1e3 * most);
}

INSTANTIATE_TEST_SUITE_P(
    All, RecordedPackets,
    ::testing::Values(Recorded{"vlp16", "VLP-16", 1, true}, Recorded{"vlp32", "VLP-32C", 2, true},
                      Recorded{"64", "Pandar64"}, Recorded{"xt32", "PandarXT-32"},
                      Recorded{"qt64", "PandarQT64"}),
    [](const auto& instance) { return std::string("of") + instance.param.folder; });

}  // namespace
}  // namespace traverse::packets
