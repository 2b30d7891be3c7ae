#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/files/atomic_file.hpp"

#include "dataset/made_recordings.hpp"
#include "temporary_folder.hpp"

/// Folders of scans as data sets have them: bare numbers, names that are stamps, tables beside.
namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using namespace traverse::testing;  // made recordings

/// A point of a made room: a ring after the other, as deep as a box of 20 by 30 m.
struct RoomPoint {
  double x, y, z, intensity, ring, time;
};

std::vector<RoomPoint> room(std::size_t rings, std::size_t points_a_ring, double ahead) {
  std::vector<RoomPoint> points;
  for (std::size_t ring = 0; ring < rings; ++ring) {
    const double slope = std::tan(0.03 * (static_cast<double>(ring) - 8));
    for (std::size_t i = 0; i < points_a_ring; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(points_a_ring);
      const double azimuth = 2 * 3.14159265358979 * share;
      const double range =
          std::min(10 / std::abs(std::cos(azimuth)), 15 / std::abs(std::sin(azimuth)));
      points.push_back({range * std::cos(azimuth) - ahead, range * std::sin(azimuth), range * slope,
                        0.5 + 0.5 * std::sin(7 * azimuth), static_cast<double>(ring), 0.1 * share});
    }
  }
  return points;
}

template <typename Number>
std::string bytes_of_room(std::size_t columns, double ahead, bool ring_first = true) {
  std::vector<Number> numbers;
  for (const RoomPoint& p : room(16, 180, ahead)) {
    const std::array<double, 6> all{
        p.x, p.y, p.z, p.intensity, ring_first ? p.ring : p.time, ring_first ? p.time : p.ring};
    for (std::size_t k = 0; k < columns; ++k) numbers.push_back(static_cast<Number>(all[k]));
  }
  std::string bytes(numbers.size() * sizeof(Number), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

std::string nclt_bytes(double ahead) {
  std::string bytes;
  for (const RoomPoint& p : room(16, 180, ahead)) {
    for (const double metres : {p.x, p.y, p.z}) {
      const auto number = static_cast<std::uint16_t>(std::round((metres + 100) / 0.005));
      bytes += static_cast<char>(number & 0xFF);
      bytes += static_cast<char>(number >> 8);
    }
    bytes += static_cast<char>(static_cast<std::uint8_t>(200 * p.intensity));
    bytes += static_cast<char>(static_cast<std::uint8_t>(p.ring));
  }
  return bytes;
}

/// A folder of three scans; `bytes` of the scan whose room is so far ahead.
template <typename Bytes>
void make_bin_folder(const fs::path& folder, const Bytes& bytes) {
  fs::create_directories(folder);
  for (int i = 0; i < 3; ++i) {
    files::write_text(folder / fmt::format("{:06}.bin", i), bytes(0.5 * i));
  }
}

void expect_room(const ScanPtr& scan, bool has_intensity, bool has_rings) {
  const auto expected = room(16, 180, 0);
  ASSERT_THAT(scan->x, SizeIs(expected.size()));
  for (const std::size_t i : {std::size_t{0}, std::size_t{517}, expected.size() - 1}) {
    EXPECT_NEAR(scan->x[i], expected[i].x, 3e-3);
    EXPECT_NEAR(scan->y[i], expected[i].y, 3e-3);
    EXPECT_NEAR(scan->z[i], expected[i].z, 3e-3);
    if (has_rings) {
      EXPECT_EQ(scan->ring.at(i), expected[i].ring);
    }
  }
  EXPECT_EQ(scan->intensity.empty(), !has_intensity);
  if (!has_rings) {
    EXPECT_THAT(scan->ring, IsEmpty());
  }
}

TEST(BinFolders, ColumnsAndTypeAreThoseThatFit) {
  for (std::size_t columns = 3; columns <= 6; ++columns) {
    for (const bool is_double : {false, true}) {
      for (const char* inside : {"", "velodyne"}) {  // bare, and in KITTI's layout
        const TemporaryFolder folder;
        make_bin_folder(folder / "drive" / inside, [&](double ahead) {
          return is_double ? bytes_of_room<double>(columns, ahead)
                           : bytes_of_room<float>(columns, ahead);
        });
        const auto source = open(folder / "drive");
        const auto scans = read_scans(*source);
        ASSERT_THAT(scans, SizeIs(3)) << columns << is_double << inside;
        expect_room(scans[0], columns > 3, columns > 4);
        const bool is_kitti = columns == 4 && !is_double;
        EXPECT_EQ(fact_value(*source, "bin columns").empty(), is_kitti);
        EXPECT_THAT(scans[0]->time, SizeIs(columns == 6 && *inside == '\0' ? scans[0]->size() : 0));
      }
    }
  }
}

TEST(BinFolders, TimeMayStandBeforeTheRing) {
  const TemporaryFolder folder;
  make_bin_folder(folder / "drive",
                  [](double ahead) { return bytes_of_room<float>(6, ahead, false); });
  const auto source = open(folder / "drive");
  EXPECT_EQ(fact_value(*source, "bin columns"), "x y z intensity time ring, float32");
  const auto scan = read_scans(*source).at(0);
  expect_room(scan, true, true);
  EXPECT_NEAR(scan->time.at(90), 0.05, 1e-6);
}

TEST(BinFolders, EightBytesAPointAreNclt) {
  const TemporaryFolder folder;
  make_bin_folder(folder / "velodyne_sync", nclt_bytes);
  const auto source = open(folder / "velodyne_sync");
  EXPECT_EQ(fact_value(*source, "bin columns"), "x y z intensity ring, nclt");
  expect_room(read_scans(*source).at(0), true, true);
}

TEST(BinFolders, BeamsThatFireInTurnsMakeNoMoreColumns) {
  const TemporaryFolder folder;
  make_bin_folder(folder / "drive/velodyne", [](double ahead) {
    const auto points = room(16, 180, ahead);
    std::string bytes;
    for (std::size_t azimuth = 0; azimuth < 180; ++azimuth) {
      for (std::size_t k = 0; k < 16; ++k) {  // 0, 8, 1, 9, ...
        const RoomPoint& p = points[(k / 2 + (k % 2) * 8) * 180 + azimuth];
        for (const double value : {p.x, p.y, p.z, p.intensity}) {
          const auto number = static_cast<float>(value);
          bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
        }
      }
    }
    return bytes;
  });
  const auto source = open(folder / "drive");
  EXPECT_EQ(fact_value(*source, "bin columns"), "");
  EXPECT_THAT(read_scans(*source).at(0)->x, SizeIs(16 * 180));
}

TEST(BinFolders, ColumnsCanBeStatedByName) {
  const TemporaryFolder folder;
  make_bin_folder(folder / "drive", [](double ahead) { return bytes_of_room<float>(5, ahead); });
  const auto source =
      open(folder / "drive", {"bin.columns=x y z reflectivity laser_id", "bin.type=float32"});
  expect_room(read_scans(*source).at(0), true, true);
  EXPECT_THAT(opening_error(folder / "drive", {"bin.columns=x y"}), HasSubstr("3 to 64 names"));
  EXPECT_THAT(opening_error(folder / "drive", {"bin.columns=x y z x"}),
              HasSubstr("each name once"));
  EXPECT_THAT(opening_error(folder / "drive", {"bin.columns=2"}), HasSubstr("3 to 64 names"));
}

TEST(BinFolders, NumbersWithoutOrderAreKittis) {
  const TemporaryFolder folder;
  make_bin_folder(folder / "drive/velodyne", [](double ahead) {
    std::string bytes;
    std::uint32_t state = 7;
    for (int i = 0; i < 4 * 3 * 5 * 40; ++i) {
      state = state * 1664525 + 1013904223;
      const float number = static_cast<float>(state >> 20) / 100 + static_cast<float>(ahead);
      bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
    }
    return bytes;
  });
  const auto source = open(folder / "drive");
  EXPECT_EQ(fact_value(*source, "bin columns"), "");
  EXPECT_THAT(read_scans(*source), SizeIs(3));
}

PointCloud one_point(float x) {
  PointCloud cloud;
  cloud.add("x", std::vector<float>{x});
  cloud.add("y", std::vector<float>{0});
  cloud.add("z", std::vector<float>{0});
  return cloud;
}

/// Seconds after the first of the stamps of scans with those names, given in their right order.
std::vector<double> seconds_of_names(const std::vector<std::string>& names,
                                     double* first = nullptr) {
  const TemporaryFolder folder;
  for (std::size_t i = 0; i < names.size(); ++i) {
    write_pcd(folder / (names[i] + ".pcd"), one_point(static_cast<float>(i) + 1));
  }
  const auto source = open(folder.path());
  std::vector<double> seconds;
  const auto scans = read_scans(*source);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(scans[i]->x[0], static_cast<float>(i) + 1);
    seconds.push_back(geometry::seconds_between(scans[0]->stamp, scans[i]->stamp));
  }
  if (first != nullptr && !scans.empty()) *first = scans[0]->stamp.seconds();
  return seconds;
}

TEST(ScanNames, EveryFormOfAStamp) {
  const std::vector<std::vector<std::string>> forms{
      {"cloud_1700000000_000000000", "cloud_1700000000_100000000", "cloud_1700000000_200000000"},
      {"1700000000_0", "1700000000_100000000", "1700000000_200000000"},
      {"1700000000.000000000", "1700000000.100000000", "1700000000.200000000"},
      {"1700000000.000000", "1700000000.100000", "1700000000.200000"},
      {"1700000000.0", "1700000000.1", "1700000000.2"},
      {"scan-1700000000.0", "scan-1700000000.1", "scan-1700000000.2"},
      {"1700000000000000000", "1700000000100000000", "1700000000200000000"},
      {"lidar_1700000000000000", "lidar_1700000000100000", "lidar_1700000000200000"},
      {"000_1700000000000", "001_1700000000100", "002_1700000000200"},
      {"frame_20231114T221320.000000", "frame_20231114T221320.100000", "frame_20231114T221320.2"}};
  for (const auto& names : forms) {
    double first = 0;
    const auto seconds = seconds_of_names(names, &first);
    ASSERT_THAT(seconds, SizeIs(3)) << names[0];
    EXPECT_NEAR(first, 1.7e9, 1e-6) << names[0];
    EXPECT_NEAR(seconds[1], 0.1, 1e-9) << names[0];
    EXPECT_NEAR(seconds[2], 0.2, 1e-9) << names[0];
  }
}

TEST(ScanNames, NanosecondsThatAreNotFilledUp) {
  // 0.95, 1.00, 1.05 and 1.10 s, of which 50 ms is written 50000000: as decimals it were half a
  // second.
  const auto seconds = seconds_of_names(
      {"1700000000.950000000", "1700000001.0", "1700000001.50000000", "1700000001.100000000"});
  ASSERT_THAT(seconds, SizeIs(4));
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(seconds[i], 0.05 * static_cast<double>(i), 1e-9);
  }
}

TEST(ScanNames, CountsAreNoStamps) {
  for (const auto& names :
       {std::vector<std::string>{"1700000000_000001", "1700000000_000002", "1700000000_000003"},
        std::vector<std::string>{"scan_1", "scan_2", "scan_3"},
        std::vector<std::string>{"20231114_01", "20231114_02", "20231114_03"},
        std::vector<std::string>{"1_20231114_221320", "2_20231114_221320", "3_20231114_221320"}}) {
    const auto seconds = seconds_of_names(names);
    ASSERT_THAT(seconds, SizeIs(3));
    EXPECT_NEAR(seconds[1], 0.1, 1e-9) << names[0];
  }
}

TEST(ScanNames, NuScenesHasTwoExtensions) {
  const TemporaryFolder folder;
  for (int i = 0; i < 2; ++i) {
    files::write_text(
        folder / fmt::format("n015-2018-07-24__LIDAR_TOP__1532402927{}47951.pcd.bin", 6 + i),
        bytes_of_room<float>(5, 0.5 * i));
  }
  const auto source = open(folder.path());
  const auto scans = read_scans(*source);
  ASSERT_THAT(scans, SizeIs(2));
  expect_room(scans[0], true, true);
  EXPECT_EQ(scans[0]->stamp.nanoseconds, 1532402927647951000);
}

TEST(TablesBesideScans, AreOneRecordingWithThem) {
  const TemporaryFolder folder;
  for (int i = 0; i < 3; ++i) {
    write_pcd(folder / fmt::format("{}.pcd", i), one_point(static_cast<float>(i) + 1));
  }
  files::write_text(folder / "times.txt", "100\n100.1\n100.2\n");
  files::write_text(folder / "imu.csv",
                    "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
                    "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n"
                    "100050000000,0.1,0,0,0,0,9.8\n100150000000,0.2,0,0,0,0,9.8\nx,0,0,0,0,0,0\n");
  files::write_text(folder / "gnss.csv", "t,latitude,longitude,altitude\n100.05,48,11,500\n");
  files::write_text(folder / "wheels.csv", "time,left,right\n100.12,1,3\n");
  files::write_text(folder / "traverse.yaml", "vehicle: {imu: {position_m: [1, 2, 3]}}\n");
  const auto source = open(folder.path());
  const auto all = read_all(*source);
  ASSERT_THAT(all, SizeIs(7));
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_LE(sensors::stamp_of(all[i - 1]), sensors::stamp_of(all[i]));
  }
  EXPECT_THAT(scans_in(all), SizeIs(3));
  EXPECT_THAT(skipped_in(*source), ElementsAre(HasSubstr("no finite number")));
  const sensors::Rig& rig = source->info().rig;
  ASSERT_TRUE(rig.first(sensors::SensorKind::kImu));
  EXPECT_EQ(rig.first(sensors::SensorKind::kImu)->T_body_sensor.translation,
            Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(rig.first(sensors::SensorKind::kGnss));
  EXPECT_TRUE(rig.first(sensors::SensorKind::kWheels));
  source->rewind();
  EXPECT_THAT(read_all(*source), SizeIs(7));
  EXPECT_THAT(skipped_in(*source), SizeIs(1));
}

TEST(TablesBesideScans, StatedColumnsAndKittisLayout) {
  const TemporaryFolder folder;
  make_kitti_folder(folder / "drive", 3);
  files::write_text(folder / "drive/inertial.csv", "when,a,b,c,d,e,f\n0.05,1,2,3,4,5,6\n");
  const auto source =
      open(folder / "drive", {"csv.gyro.file=inertial.csv", "csv.gyro.time=when",
                              "csv.gyro.columns=a b c", "csv.accelerometer.file=inertial.csv",
                              "csv.accelerometer.time=when", "csv.accelerometer.columns=d e f"});
  EXPECT_THAT(read_all(*source), SizeIs(4));
  EXPECT_TRUE(source->info().rig.first(sensors::SensorKind::kImu));
}

TEST(TablesBesideScans, ATableThatIsNotUnderstoodIsTold) {
  const TemporaryFolder folder;
  write_pcd(folder / "0.pcd", one_point(1));
  files::write_text(folder / "imu.csv", "a,b\n1,2\n");
  const auto source = open(folder.path());
  EXPECT_EQ(fact_value(*source, "not used"), "imu.csv");
  EXPECT_THAT(read_all(*source), SizeIs(1));
}

TEST(TablesBesideScans, EurocsFolderOpensAsItIs) {
  for (const char* inside : {"imu0", "mav0/imu0"}) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "drive" / inside);
    files::write_text(folder / "drive" / inside / "data.csv",
                      "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
                      "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n"
                      "1403636579758555392,0.1,0,0,0,0,9.8\n1403636579763555584,0.2,0,0,0,0,9.8\n");
    const auto source = open(folder / "drive");
    const auto all = read_all(*source);
    ASSERT_THAT(all, SizeIs(2)) << inside;
    EXPECT_NEAR(sensors::stamp_of(all[0]).seconds(), 1403636579.758555, 1e-6);
    const auto own = open(folder / "drive" / inside);
    EXPECT_THAT(read_all(*own), SizeIs(2)) << inside;
  }
}

}  // namespace
}  // namespace traverse::dataset
