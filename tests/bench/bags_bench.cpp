// Processor time of reading a bag with every point decoded, against that of unpacking the same
// messages packed as one piece.

#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <lz4frame.h>
#include <memory>
#include <random>
#include <string>
#include <vector>
#include <zstd.h>

#include "traverse/dataset/open_recording.hpp"

#include "bags/bag_writers.hpp"
#include "bench/cpu_seconds.hpp"
#include "temporary_folder.hpp"

namespace traverse {
namespace {

using namespace testing;

constexpr std::size_t kScans = 100;
constexpr std::size_t kRings = 64;
constexpr std::size_t kColumns = 1024;
constexpr std::uint32_t kPointBytes = 22;

template <typename Number>
void put(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// A lidar of 64 rings in a round room with walls that bulge, to four millimetres.
std::string points_of_turn(std::mt19937& random) {
  std::string data;
  data.reserve(kPointBytes * kRings * kColumns);
  for (std::size_t column = 0; column < kColumns; ++column) {
    for (std::size_t ring = 0; ring < kRings; ++ring) {
      const double share = static_cast<double>(column) / kColumns;
      const double azimuth = 2 * M_PI * share;
      const double elevation = (-25 + 40.0 * static_cast<double>(ring) / kRings) * M_PI / 180;
      const double noise = 0.004 * static_cast<double>(random() % 10);
      const double range = std::round((10 + 5 * std::sin(3 * azimuth) + noise) * 250) / 250;
      put(data, static_cast<float>(range * std::cos(elevation) * std::cos(azimuth)));
      put(data, static_cast<float>(range * std::cos(elevation) * std::sin(azimuth)));
      put(data, static_cast<float>(range * std::sin(elevation)));
      put(data, static_cast<float>(random() % 256));
      put(data, static_cast<std::uint16_t>(ring));
      put(data, static_cast<float>(0.1 * share));
    }
  }
  return data;
}

std::vector<MadeMessage> made_drive(Wire wire) {
  constexpr std::int64_t kTenth = 100'000'000;
  std::mt19937 random(1);
  std::vector<MadeMessage> messages;
  CloudMessage cloud;
  cloud.fields = {{"x", 0}, {"y", 4}, {"z", 8}, {"intensity", 12}, {"ring", 16, 4}, {"time", 18}};
  cloud.width = kRings * kColumns;
  cloud.point_step = kPointBytes;
  cloud.row_step = cloud.point_step * cloud.width;
  for (std::size_t i = 0; i < kScans; ++i) {
    const std::int64_t ns = 1'700'000'000'000'000'000 + static_cast<std::int64_t>(i) * kTenth;
    cloud.data = points_of_turn(random);
    messages.push_back(
        {"/points", "sensor_msgs/PointCloud2", ns, cloud_message(wire, ns, "lidar", cloud)});
    for (std::int64_t k = 0; k < 10; ++k) {
      const std::int64_t at = ns + k * kTenth / 10;
      messages.push_back(
          {"/imu", "sensor_msgs/Imu", at, imu_message(wire, at, "imu", {0, 0, 0.1}, {0, 0, 9.81})});
    }
  }
  return messages;
}

void unpack_as_one(const std::string& packing, const std::string& packed, std::string& room) {
  if (packing == "zstd") {
    ZSTD_decompress(room.data(), room.size(), packed.data(), packed.size());
    return;
  }
  LZ4F_dctx* context = nullptr;
  LZ4F_createDecompressionContext(&context, LZ4F_VERSION);
  for (std::size_t read = 0, made = 0; made < room.size();) {
    std::size_t taken = packed.size() - read;
    std::size_t given = room.size() - made;
    LZ4F_decompress(context, room.data() + made, &given, packed.data() + read, &taken, nullptr);
    if (taken == 0 && given == 0) break;
    read += taken;
    made += given;
  }
  LZ4F_freeDecompressionContext(context);
}

void measure(const std::string& name, const std::string& packing,
             const std::function<void(const std::filesystem::path&)>& write,
             const std::vector<MadeMessage>& messages) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / name;
  write(file);
  std::string whole;
  for (const MadeMessage& message : messages) whole += message.bytes;
  const std::string packed = packed_by(packing, whole);
  std::string room(whole.size(), '\0');
  const double one_s = cpu_seconds_of([&] { unpack_as_one(packing, packed, room); });
  std::size_t points = 0;
  const auto source = dataset::open_recording(file, {{}, {}, TRAVERSE_SHARE_DIR});
  const double all_s = cpu_seconds_of([&] {
    while (const auto measurement = source->next()) {
      if (const auto* scan =
              std::get_if<std::shared_ptr<const sensors::LidarScan>>(&*measurement)) {
        points += (*scan)->size();
      }
    }
  });
  std::printf("%s (%s): %.3f s, %.1f ns a point; as one piece %.3f s: %.2f times\n", name.c_str(),
              packing.c_str(), all_s, 1e9 * all_s / static_cast<double>(points), one_s,
              all_s / one_s);
}

}  // namespace
}  // namespace traverse

int main() {
  using namespace traverse;
  const auto ros1 = made_drive(testing::Wire::kRos1);
  measure(
      "a.bag", "lz4",
      [&](const auto& file) {
        testing::write_ros1_bag(file, ros1, {"lz4", 5, false, true, true});
      },
      ros1);
  const auto ros2 = made_drive(testing::Wire::kCdr);
  for (const char* packing : {"lz4", "zstd"}) {
    measure(
        "a.mcap", packing,
        [&](const auto& file) {
          testing::write_mcap(file, ros2, {packing, 30, false, true, true});
        },
        ros2);
  }
}
