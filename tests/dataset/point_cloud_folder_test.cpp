#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/files/atomic_file.hpp"

#include "dataset/made_recordings.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::FloatEq;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace traverse::testing;  // made recordings

/// Three points; more fields by add().
PointCloud three_points(float x = 0) {
  PointCloud cloud;
  cloud.add("x", std::vector<float>{x, 1, 2});
  cloud.add("y", std::vector<float>{3, 4, 5});
  cloud.add("z", std::vector<float>{6, 7, 8});
  return cloud;
}

/// The only scan of a folder with `cloud`, whose stamp is `stamp_s`.
ScanPtr scan_of(const PointCloud& cloud, const char* stamp = "100.5",
                std::vector<std::string>* facts = nullptr) {
  const TemporaryFolder folder;
  write_pcd(folder / "1.pcd", cloud);
  files::write_text(folder / "times.txt", std::string(stamp) + "\n");
  const auto source = open(folder.path());
  if (facts != nullptr) {
    *facts = {fact_value(*source, "time field"), fact_reason(*source, "time field"),
              fact_value(*source, "point times"), fact_value(*source, "rings")};
  }
  const auto scans = read_scans(*source);
  return scans.size() == 1 ? scans[0] : nullptr;
}

TEST(PointCloudFolder, ReadsFieldsOfAnyTypeAndOrder) {
  PointCloud cloud;
  cloud.add("ring", std::vector<std::int32_t>{0, 1, 300});
  cloud.add("z", std::vector<double>{6, 7, 8});
  cloud.add("intensity", std::vector<std::uint8_t>{0, 128, 255});
  cloud.add("x", std::vector<double>{0.5, 1, 2});
  cloud.add("y", std::vector<std::int16_t>{3, 4, 5});
  const ScanPtr scan = scan_of(cloud);
  ASSERT_TRUE(scan);
  EXPECT_THAT(scan->x, ElementsAre(0.5F, 1, 2));
  EXPECT_THAT(scan->y, ElementsAre(3, 4, 5));
  EXPECT_THAT(scan->z, ElementsAre(6, 7, 8));
  EXPECT_THAT(scan->intensity, ElementsAre(0, 128, 255));
  EXPECT_THAT(scan->ring, ElementsAre(0, 1, 300));
  EXPECT_THAT(scan->time, IsEmpty());
  EXPECT_EQ(scan->sensor, "lidar");
}

TEST(PointCloudFolder, TheFieldsMakeTheDefaultProfile) {
  const TemporaryFolder folder;
  PointCloud cloud = three_points();
  cloud.add("ring", std::vector<std::uint8_t>{0, 15, 3});
  cloud.add("intensity", std::vector<std::uint16_t>{1, 2, 3});
  cloud.add("t", std::vector<float>{0, 0.01F, 0.09F});
  write_ply(folder / "0.ply", cloud);
  const auto source = open(folder.path());
  const sensors::LidarProfile& profile = *source->info().rig.sensors.at(0).lidar;
  EXPECT_EQ(profile.rings, 16);
  EXPECT_EQ(profile.ring_source, sensors::RingSource::kData);
  EXPECT_EQ(profile.time_source, sensors::TimeSource::kData);
  EXPECT_EQ(profile.intensity_full_scale, 65535);
  EXPECT_EQ(source->info().format, "point-cloud folder");
  EXPECT_FALSE(source->info().motion_compensated);
}

TEST(PointCloudFolder, RelativeTimesAreFromTheStamp) {
  for (const bool nanoseconds : {false, true}) {
    PointCloud cloud = three_points();
    if (nanoseconds) {
      cloud.add("t", std::vector<std::uint32_t>{0, 50'000'000, 100'000'000});
    } else {
      cloud.add("time", std::vector<double>{0, 0.05, 0.1});
    }
    std::vector<std::string> facts;
    const ScanPtr scan = scan_of(cloud, "100.5", &facts);
    EXPECT_THAT(scan->time, ElementsAre(0, FloatEq(0.05F), FloatEq(0.1F)));
    EXPECT_EQ(facts[0], nanoseconds ? "field 't', nanoseconds, after the scan's stamp"
                                    : "field 'time', seconds, after the scan's stamp");
    EXPECT_THAT(facts[1], HasSubstr("in a scan, and scans are 0.1 s apart"));
    EXPECT_EQ(facts[2], "stored with the points");
  }
}

TEST(PointCloudFolder, AbsoluteTimesKeepTheirNanoseconds) {
  PointCloud cloud = three_points();
  cloud.add("timestamp", std::vector<std::int64_t>{1317042145000000001, 1317042145050000001,
                                                   1317042144950000001});
  std::vector<std::string> facts;
  const ScanPtr scan = scan_of(cloud, "1317042145.000000001", &facts);
  EXPECT_THAT(scan->time, ElementsAre(0, FloatEq(0.05F), FloatEq(-0.05F)));
  EXPECT_EQ(facts[0], "field 'timestamp', nanoseconds, absolute");
}

TEST(PointCloudFolder, AbsoluteSecondsAsDoubles) {
  PointCloud cloud = three_points();
  cloud.add("timestamp", std::vector<double>{1317042145.0, 1317042145.05,
                                             std::numeric_limits<double>::quiet_NaN()});
  const ScanPtr scan = scan_of(cloud, "1317042145.0");
  EXPECT_EQ(scan->time[0], 0);
  EXPECT_NEAR(scan->time[1], 0.05, 1e-6);
  EXPECT_TRUE(std::isnan(scan->time[2]));
}

TEST(PointCloudFolder, AbsoluteTimesOfAnotherClockStartAtTheStamp) {
  PointCloud cloud = three_points();
  cloud.add("timestamp", std::vector<double>{5000.05, 5000.0, 5000.1});
  std::vector<std::string> facts;
  const ScanPtr scan = scan_of(cloud, "100.5", &facts);
  EXPECT_NEAR(scan->time[0], 0.05, 1e-6);
  EXPECT_EQ(scan->time[1], 0);
  EXPECT_THAT(facts[0], HasSubstr("another clock"));
}

TEST(PointCloudFolder, MicrosecondsAndNanosecondsAsFloatsShowByTheirSpan) {
  PointCloud cloud = three_points();
  cloud.add("time", std::vector<float>{0, 50'000, 100'000});
  EXPECT_THAT(scan_of(cloud)->time, ElementsAre(0, FloatEq(0.05F), FloatEq(0.1F)));
  cloud = three_points();
  cloud.add("time", std::vector<double>{0, 5e7, 1e8});
  EXPECT_THAT(scan_of(cloud)->time, ElementsAre(0, FloatEq(0.05F), FloatEq(0.1F)));
}

/// Scans of a sweep of 0.1 s, so far apart, whose times count `unit_s`.
template <typename Number>
std::unique_ptr<Source> with_times_in(const fs::path& folder, double unit_s, double interval_s,
                                      std::vector<std::string> statements = {}) {
  std::string times;
  for (int i = 0; i < 4; ++i) {
    PointCloud cloud = three_points();
    std::vector<Number> values;
    for (const double seconds : {0.0, 0.05, 0.1}) {
      values.push_back(static_cast<Number>(std::round(seconds / unit_s * 1e6) / 1e6));
    }
    cloud.add("time", values);
    write_pcd(folder / fmt::format("{}.pcd", i), cloud);
    times += fmt::format("{}\n", 100 + i * interval_s);
  }
  files::write_text(folder / "times.txt", times);
  return open(folder, std::move(statements));
}

TEST(PointCloudFolder, TheUnitOfTimesIsToldByTheTimeToTheNextScan) {
  for (const double interval_s : {0.05, 0.1, 0.5, 20.0}) {  // of every n-th scan too
    for (const double unit_s : {1e-3, 1e-6, 1e-9}) {
      const TemporaryFolder folder;
      const auto scan = [&](auto number) {
        const auto source =
            with_times_in<decltype(number)>(folder.path(), unit_s, std::max(interval_s, 0.07));
        return read_scans(*source).at(0);
      };
      EXPECT_THAT(scan(float{})->time, ElementsAre(0, FloatEq(0.05F), FloatEq(0.1F))) << unit_s;
      EXPECT_THAT(scan(double{})->time, ElementsAre(0, FloatEq(0.05F), FloatEq(0.1F))) << unit_s;
      EXPECT_THAT(scan(std::uint32_t{})->time, ElementsAre(0, FloatEq(0.05F), FloatEq(0.1F)))
          << unit_s;
      if (unit_s < 1e-3) continue;
      EXPECT_THAT(scan(std::uint16_t{})->time, ElementsAre(0, FloatEq(0.05F), FloatEq(0.1F)));
      EXPECT_THAT(scan(std::uint8_t{})->time, ElementsAre(0, FloatEq(0.05F), FloatEq(0.1F)));
    }
    const TemporaryFolder folder;
    const auto source = with_times_in<float>(folder.path(), 1, std::max(interval_s, 0.07));
    EXPECT_THAT(read_scans(*source).at(0)->time, ElementsAre(0, FloatEq(0.05F), FloatEq(0.1F)));
  }
}

TEST(PointCloudFolder, AStatedUnitOfTimesIsStronger) {
  const TemporaryFolder folder;
  const auto source = with_times_in<float>(folder.path(), 1e-3, 0.1, {"point_time_unit_s=0.0005"});
  EXPECT_THAT(read_scans(*source).at(0)->time, ElementsAre(0, FloatEq(0.025F), FloatEq(0.05F)));
  EXPECT_THAT(fact_reason(*source, "time field"), HasSubstr("point_time_unit_s"));
}

TEST(PointCloudFolder, AScanWithOneTimeForAllPointsDecidesNothing) {
  const TemporaryFolder folder;
  static_cast<void>(with_times_in<float>(folder.path(), 1, 0.1));
  PointCloud cloud = three_points();
  cloud.add("time", std::vector<float>{0.02F, 0.02F, 0.02F});
  write_pcd(folder / "3.pcd", cloud);  // the last one is what the others are judged by
  const auto source = open(folder.path());
  const auto scans = read_scans(*source);
  ASSERT_EQ(scans.size(), 4U);
  EXPECT_THAT(scans[0]->time, ElementsAre(0, FloatEq(0.05F), FloatEq(0.1F)));
  EXPECT_THAT(scans[3]->time, ElementsAre(0.02F, 0.02F, 0.02F));
}

TEST(PointCloudFolder, NamesOfTimeFieldsOfTheField) {
  for (const char* name : {"t", "offset_time", "scalar_timestamp", "timestamp", "scalar_time"}) {
    PointCloud cloud = three_points();
    cloud.add(name, std::vector<std::uint32_t>{0, 50'000'000, 100'000'000});
    EXPECT_THAT(scan_of(cloud)->time, ElementsAre(0, FloatEq(0.05F), FloatEq(0.1F))) << name;
  }
  PointCloud cloud = three_points();
  cloud.add("receive_times", std::vector<std::uint32_t>{0, 50'000'000, 100'000'000});
  std::vector<std::string> facts;
  EXPECT_THAT(scan_of(cloud, "1", &facts)->time, IsEmpty());
  EXPECT_THAT(facts[1], HasSubstr("lidar.time_field=receive_times"));
}

TEST(PointCloudFolder, CoordinatesInAStatedUnit) {
  const TemporaryFolder folder;
  write_pcd(folder / "1.pcd", three_points(500));
  const auto source = open(folder.path(), {"point_unit_m=0.001"});
  EXPECT_THAT(read_scans(*source).at(0)->x, ElementsAre(0.5F, FloatEq(0.001F), FloatEq(0.002F)));
}

TEST(PointCloudFolder, TimesThatTellNothingAreNotUsed) {
  std::vector<std::string> facts;
  PointCloud equal = three_points();
  equal.add("time", std::vector<float>{0, 0, 0});
  EXPECT_THAT(scan_of(equal, "1", &facts)->time, IsEmpty());
  EXPECT_THAT(facts[1], HasSubstr("'time' is the same for all points"));
  EXPECT_EQ(facts[2], "unknown");
  PointCloud coarse = three_points();  // a float holds today's seconds to 128 s
  coarse.add("time", std::vector<float>{1317042176.F, 1317042304.F, 1317042176.F});
  EXPECT_THAT(scan_of(coarse, "1317042145", &facts)->time, IsEmpty());
  EXPECT_THAT(facts[1], HasSubstr("steps of"));
  PointCloud endless = three_points();
  endless.add("time", std::vector<double>{0, 1e12, 1});
  EXPECT_THAT(scan_of(endless, "1", &facts)->time, IsEmpty());
  EXPECT_THAT(facts[1], HasSubstr("spans 1e+12 in one scan, which in no unit fits"));
  EXPECT_THAT(facts[1], HasSubstr("lidar.time_unit=s, ms, us or ns"));
}

TEST(PointCloudFolder, NamesThatAreTimesAreTheStamps) {
  for (const auto& [first, second] :
       {std::pair("9.5", "10.25"), std::pair("1317042145000000000", "1317042145750000000"),
        std::pair("1317042145000000", "1317042145750000")}) {
    const TemporaryFolder folder;
    write_pcd(folder / (std::string(second) + ".pcd"), three_points(20));
    write_pcd(folder / (std::string(first) + ".pcd"), three_points(10));
    const auto source = open(folder.path());
    const auto scans = read_scans(*source);
    ASSERT_EQ(scans.size(), 2U) << first;
    EXPECT_EQ(scans[0]->x[0], 10);
    EXPECT_NEAR(seconds_between(scans[0]->stamp, scans[1]->stamp), 0.75, 1e-12) << first;
    EXPECT_EQ(fact_value(*source, "scan stamps"), "the files' names");
  }
}

TEST(PointCloudFolder, CountsAreNotTimesAndSortNaturally) {
  const TemporaryFolder folder;
  for (const int i : {0, 2, 9, 10, 100}) {
    write_pcd(folder / fmt::format("scan{}.pcd", i), three_points(static_cast<float>(i)));
  }
  const auto source = open(folder.path(), {"period_s=0.2"});
  std::vector<float> order;
  for (const auto& scan : read_scans(*source)) order.push_back(scan->x[0]);
  EXPECT_THAT(order, ElementsAre(0, 2, 9, 10, 100));
  source->rewind();
  EXPECT_THAT(milliseconds_of(read_scans(*source)), ElementsAre(0, 200, 400, 600, 800));
  EXPECT_EQ(fact_reason(*source, "scan stamps"), "--recording period_s=0.2");
}

TEST(PointCloudFolder, BrokenScansAreSkippedAndCounted) {
  const TemporaryFolder folder;
  for (int i = 0; i < 6; ++i) {
    write_pcd(folder / fmt::format("{}.pcd", i), three_points(static_cast<float>(i)));
  }
  files::write_text(folder / "1.pcd", "FIELDS x\nSIZE 4\nTYPE F\nPOINTS 3\nDATA binary\n1234");
  files::write_text(folder / "2.pcd", "");
  PointCloud flat;
  flat.add("x", std::vector<float>{1});
  write_pcd(folder / "3.pcd", flat);
  PointCloud bad_ring = three_points();  // rings that no other scan has are not needed
  bad_ring.add("ring", std::vector<std::int32_t>{0, -1, 0});
  write_pcd(folder / "4.pcd", bad_ring);
  const auto source = open(folder.path());
  EXPECT_THAT(milliseconds_of(read_scans(*source)), ElementsAre(0, 400, 500));
  EXPECT_THAT(skipped_in(*source),
              ElementsAre("1 x scan cannot be used: expected 3 points of 4 bytes",
                          "1 x scan cannot be used: expected fields x, y and z",
                          "1 x scan cannot be used: expected the beginning of a PCD or PLY file"));
}

TEST(PointCloudFolder, AScanWithoutTheTimeFieldOfTheOthersIsSkipped) {
  const TemporaryFolder folder;
  PointCloud timed = three_points();
  timed.add("time", std::vector<float>{0, 0.05F, 0.1F});
  write_pcd(folder / "0.pcd", timed);
  write_pcd(folder / "1.pcd", three_points());
  write_pcd(folder / "2.pcd", timed);
  const auto source = open(folder.path());
  EXPECT_THAT(milliseconds_of(read_scans(*source)), ElementsAre(0, 200));
  EXPECT_THAT(skipped_in(*source).at(0), HasSubstr("a field 'time' as in the other scans"));
}

TEST(PointCloudFolder, OnlyOneKindOfFileIsTaken) {
  const TemporaryFolder folder;
  write_pcd(folder / "0.pcd", three_points());
  write_pcd(folder / "1.PCD", three_points());
  write_ply(folder / "map.ply", three_points());
  const auto source = open(folder.path());
  EXPECT_EQ(read_scans(*source).size(), 2U);
  EXPECT_EQ(fact_value(*source, "files left out"), "1 *.ply");
}

TEST(PointCloudFolder, AFolderOfNothingReadableIsAnError) {
  const TemporaryFolder folder;
  files::write_text(folder / "0.pcd", "junk");
  EXPECT_THAT(opening_error(folder.path()),
              HasSubstr("expected a point cloud with a stamp that can be read, found"));
  EXPECT_THAT(opening_error(folder.path()), HasSubstr("'junk'"));
}

TEST(PointCloudFolder, TakesStatementsLikeTheOthers) {
  const TemporaryFolder folder;
  write_pcd(folder / "0.pcd", three_points());
  files::write_text(folder / "gt.tum", "0 1 2 3 0 0 0 1\n");
  files::write_text(folder / "traverse.yaml",
                    "sensor: hdl64e_kitti\nreference: {file: gt.tum}\nmotion_compensated: true\n");
  const auto source = open(folder.path());
  EXPECT_EQ(source->info().rig.sensors.at(0).lidar->ring_source,
            sensors::RingSource::kStorageOrder);
  EXPECT_TRUE(source->info().motion_compensated);
  ASSERT_TRUE(source->reference());
  EXPECT_EQ(source->reference()->T_map_body.pose(0).translation, Eigen::Vector3d(1, 2, 3));
}

}  // namespace
}  // namespace traverse::dataset
