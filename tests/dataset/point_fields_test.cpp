#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/files/atomic_file.hpp"

#include "dataset/made_recordings.hpp"
#include "temporary_folder.hpp"

/// Which field of a point holds what, whatever it is called and counts.
namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using namespace traverse::testing;  // made recordings

constexpr double kStart = 1700000000;
constexpr std::size_t kScans = 6;

/// A folder of scans of four points 0.1 s apart, to which `add` gives more fields.
class Drive {
 public:
  template <typename Add>
  explicit Drive(const Add& add, std::vector<std::string> statements = {}) {
    std::string times;
    for (std::size_t i = 0; i < kScans; ++i) {
      PointCloud cloud;
      cloud.add("x", std::vector<float>{1, 2, 3, 4});
      cloud.add("y", std::vector<float>{3, 4, 5, 6});
      cloud.add("z", std::vector<float>{6, 7, 8, 9});
      add(cloud, i);
      write_pcd(folder_ / fmt::format("{}.pcd", i), cloud);
      times += fmt::format("{:.9f}\n", kStart + 0.1 * static_cast<double>(i));
    }
    files::write_text(folder_ / "times.txt", times);
    source_ = open(folder_.path(), std::move(statements));
    scans_ = read_scans(*source_);
  }
  const Source& source() const { return *source_; }
  const std::vector<ScanPtr>& scans() const { return scans_; }
  const fs::path& folder() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
  std::unique_ptr<Source> source_;
  std::vector<ScanPtr> scans_;
};

/// Times of a sweep that begins `begin_s` after the scan's stamp, in that unit.
template <typename Number>
std::vector<Number> sweep(double begin_s, double unit_s, double zero_s = 0) {
  std::vector<Number> times;
  for (const double share : {0.0, 0.03, 0.06, 0.09}) {
    times.push_back(
        static_cast<Number>(std::round((zero_s + begin_s + share) / unit_s * 1e3) / 1e3));
  }
  return times;
}

void expect_sweep(const Drive& drive, double begin_s) {
  ASSERT_THAT(drive.scans(), SizeIs(kScans)) << fact_reason(drive.source(), "time field");
  for (const ScanPtr& scan : drive.scans()) {
    ASSERT_THAT(scan->time, SizeIs(4)) << fact_reason(drive.source(), "time field");
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(scan->time[k], begin_s + 0.03 * static_cast<double>(k), 2e-6)
          << fact_value(drive.source(), "time field");
    }
  }
}

TEST(PointFields, TimesByAnyOfTheNamesOfTheField) {
  for (const char* name :
       {"t", "time", "time_stamp", "timestamp", "timestamps", "offset_time", "timeoffset",
        "GpsTime", "TIME", "scalar_GpsTime", "scalar_Timestamp", "offset_ns", "time_ns"}) {
    const Drive drive(
        [&](PointCloud& cloud, std::size_t) { cloud.add(name, sweep<std::uint32_t>(0, 1e-9)); });
    expect_sweep(drive, 0);
    EXPECT_THAT(fact_value(drive.source(), "time field"), HasSubstr(name));
  }
}

TEST(PointFields, RelativeToStartMiddleAndEndInEveryUnit) {
  for (const double begin_s : {0.0, -0.045, -0.09}) {
    for (const double unit_s : {1.0, 1e-3, 1e-6, 1e-9}) {
      const Drive doubles([&](PointCloud& cloud, std::size_t) {
        cloud.add("time", sweep<double>(begin_s, unit_s));
      });
      expect_sweep(doubles, begin_s);
      const Drive floats([&](PointCloud& cloud, std::size_t) {
        cloud.add("time", sweep<float>(begin_s, unit_s));
      });
      expect_sweep(floats, begin_s);
      if (unit_s > 1e-4) continue;  // 0.03 s is no whole number of more
      const Drive integers([&](PointCloud& cloud, std::size_t) {
        cloud.add("time", sweep<std::int32_t>(begin_s, unit_s));
      });
      expect_sweep(integers, begin_s);
    }
  }
}

TEST(PointFields, AbsoluteInEveryUnit) {
  for (const double unit_s : {1.0, 1e-3, 1e-6}) {
    const Drive drive([&](PointCloud& cloud, std::size_t i) {
      cloud.add("timestamp", sweep<double>(-0.045, unit_s, kStart + 0.1 * static_cast<double>(i)));
    });
    expect_sweep(drive, -0.045);
    EXPECT_THAT(fact_value(drive.source(), "time field"), HasSubstr("absolute"));
  }
}

TEST(PointFields, SecondsAndNanosecondsInTwoFields) {
  for (const auto& [seconds, nanoseconds] :
       {std::pair("timestamp_sec", "timestamp_nsec"), std::pair("t_sec", "t_nsec"),
        std::pair("sec", "nsec"), std::pair("scalar_time_s", "scalar_time_ns")}) {
    const Drive drive([&, a = seconds, b = nanoseconds](PointCloud& cloud, std::size_t i) {
      std::vector<std::uint32_t> whole;
      std::vector<std::uint32_t> rest;
      for (std::uint64_t k = 0; k < 4; ++k) {  // over the end of a second in some scans
        const std::uint64_t ns = 100'000'000 * i + 30'000'000 * k + 700'000'000;
        whole.push_back(static_cast<std::uint32_t>(1699999999 + ns / 1'000'000'000));
        rest.push_back(static_cast<std::uint32_t>(ns % 1'000'000'000));
      }
      cloud.add(a, whole);
      cloud.add(b, rest);
    });
    // 0.3 s before the stamps: another clock, whose scans begin at their stamps.
    expect_sweep(drive, 0);
    EXPECT_THAT(fact_value(drive.source(), "time field"), HasSubstr("seconds and nanoseconds"));
  }
}

TEST(PointFields, CurvatureIsATimeOnlyInMilliseconds) {
  const Drive times(
      [](PointCloud& cloud, std::size_t) { cloud.add("curvature", sweep<float>(0, 1e-3)); });
  expect_sweep(times, 0);
  const Drive none([](PointCloud& cloud, std::size_t) {
    cloud.add("curvature", std::vector<float>{0, 0.1F, 0.3F, 0.2F});
  });
  EXPECT_THAT(none.scans().at(0)->time, IsEmpty());
  EXPECT_THAT(fact_reason(none.source(), "time field"), HasSubstr("not in milliseconds"));
}

TEST(PointFields, AClockOfItsOwnMustGoAsTheStampsDo) {
  const Drive drive([](PointCloud& cloud, std::size_t i) {
    cloud.add("timestamp", sweep<double>(0, 1, 5000 + 0.1 * static_cast<double>(i)));
  });
  expect_sweep(drive, 0);
  EXPECT_THAT(fact_value(drive.source(), "time field"), HasSubstr("another clock"));
  const Drive other([](PointCloud& cloud, std::size_t i) {
    cloud.add("timestamp", sweep<double>(0, 1, 5000 + 7 * static_cast<double>(i)));
  });
  EXPECT_THAT(other.scans().at(0)->time, IsEmpty());
  EXPECT_THAT(fact_reason(other.source(), "time field"), HasSubstr("lidar.time_zero="));
}

TEST(PointFields, WhereTheStampIsInASweepCanBeStated) {
  for (const auto& [zero, begin_s] :
       {std::pair("start", 0.0), std::pair("middle", -0.045), std::pair("end", -0.09)}) {
    const Drive drive(
        [](PointCloud& cloud, std::size_t i) {
          cloud.add("timestamp", sweep<double>(0, 1, 5000 + 0.1 * static_cast<double>(i)));
        },
        {fmt::format("lidar.time_zero={}", zero)});
    expect_sweep(drive, begin_s);
    const Drive relative(
        [](PointCloud& cloud, std::size_t) { cloud.add("t", sweep<float>(0, 1e-3)); },
        {fmt::format("lidar.time_zero={}", zero)});
    expect_sweep(relative, begin_s);
  }
}

TEST(PointFields, FieldAndUnitCanBeStated) {
  const Drive drive(
      [](PointCloud& cloud, std::size_t) {
        cloud.add("when", sweep<float>(0, 1e-3));
        cloud.add("row", std::vector<std::uint8_t>{0, 1, 2, 7});
      },
      {"lidar.time_field=when", "lidar.time_unit=ms", "lidar.ring_field=row"});
  expect_sweep(drive, 0);
  EXPECT_THAT(drive.scans().at(0)->ring, ElementsAre(0, 1, 2, 7));
  EXPECT_THAT(opening_error(drive.folder(), {"lidar.time_field=then"}), HasSubstr("'then'"));
  EXPECT_THAT(opening_error(drive.folder(), {"lidar.ring_field=none"}), HasSubstr("'none'"));
}

TEST(PointFields, AStatedUnitThatCannotBeIsRefused) {
  const Drive drive([](PointCloud& cloud, std::size_t) { cloud.add("t", sweep<float>(0, 1e-3)); });
  EXPECT_THAT(opening_error(drive.folder(), {"lidar.time_unit=s"}),
              HasSubstr("which is 90 s in the unit that is stated"));
  EXPECT_EQ(opening_error(drive.folder(), {"lidar.time_unit=ms"}), "no error");
}

TEST(PointFields, TwoFieldsThatDisagreeSettleNothing) {
  const auto add_both = [](PointCloud& cloud, std::size_t) {
    cloud.add("time", sweep<float>(0, 1));
    cloud.add("timestamp", std::vector<float>{0, 10, 20, 30});
  };
  const Drive drive(add_both);
  EXPECT_THAT(drive.scans().at(0)->time, IsEmpty());
  EXPECT_THAT(fact_reason(drive.source(), "time field"), HasSubstr("both fit"));
  const Drive stated(add_both, {"lidar.time_field=time"});
  expect_sweep(stated, 0);
  const Drive agreeing([](PointCloud& cloud, std::size_t i) {
    cloud.add("t", sweep<std::uint32_t>(0, 1e-9));
    cloud.add("timestamp", sweep<double>(0, 1, kStart + 0.1 * static_cast<double>(i)));
  });
  expect_sweep(agreeing, 0);
}

TEST(PointFields, OneBadScanDecidesNothing) {
  for (const std::size_t bad : {std::size_t{0}, kScans / 2, kScans - 1}) {
    const Drive drive([&](PointCloud& cloud, std::size_t i) {
      auto times = sweep<double>(0, 1);
      if (i == bad) times[1] = 1e9;
      cloud.add("time", times);
    });
    ASSERT_THAT(drive.scans(), SizeIs(kScans - 1));
    for (const ScanPtr& scan : drive.scans()) EXPECT_THAT(scan->time, SizeIs(4));
    EXPECT_THAT(skipped_in(drive.source()), ElementsAre(HasSubstr("times of one scan")));
  }
}

TEST(PointFields, TimesOfPointsWithoutAReturnCountForNothing) {
  for (const float missing : {0.0F, std::numeric_limits<float>::quiet_NaN()}) {
    const Drive drive([&](PointCloud& cloud, std::size_t i) {
      PointCloud with_missing;
      for (const char* name : {"x", "y", "z"}) {
        auto values = std::get<std::vector<float>>(*cloud.find(name));
        values[2] = missing;
        with_missing.add(name, values);
      }
      auto times = sweep<double>(0, 1, kStart + 0.1 * static_cast<double>(i));
      times[2] = 0;  // as drivers leave it
      with_missing.add("timestamp", times);
      with_missing.add("ring", std::vector<float>{0, 1, missing, 2});
      cloud = with_missing;
    });
    ASSERT_THAT(drive.scans(), SizeIs(kScans));
    EXPECT_NEAR(drive.scans()[0]->time.at(3), 0.09, 1e-6);
    EXPECT_TRUE(std::isnan(drive.scans()[0]->time[2]));
    EXPECT_THAT(drive.scans()[0]->ring, ElementsAre(0, 1, 0, 2));
  }
}

TEST(PointFields, RingsByAnyOfTheNamesOfTheField) {
  for (const char* name : {"Ring", "channel", "line", "laser_id", "scalar_ring", "CHANNEL"}) {
    const Drive drive([&](PointCloud& cloud, std::size_t) {
      cloud.add(name, std::vector<std::uint8_t>{0, 3, 1, 2});
    });
    EXPECT_THAT(drive.scans().at(0)->ring, ElementsAre(0, 3, 1, 2)) << name;
    EXPECT_EQ(drive.source().info().rig.sensors.at(0).lidar->rings, 4) << name;
  }
  const Drive none([&](PointCloud& cloud, std::size_t) {
    cloud.add("channel", std::vector<float>{0.5F, 3, 1, 2});  // of a camera, say
  });
  EXPECT_THAT(none.scans().at(0)->ring, IsEmpty());
}

TEST(PointFields, NamesOfPdal) {
  const TemporaryFolder folder;
  PointCloud cloud;
  cloud.add("X", std::vector<double>{1, 2, 3, 4});
  cloud.add("Y", std::vector<double>{1, 2, 3, 4});
  cloud.add("Z", std::vector<double>{1, 2, 3, 4});
  cloud.add("Intensity", std::vector<std::uint16_t>{1, 2, 3, 4});
  cloud.add("GpsTime", sweep<double>(0, 1, 5000));
  cloud.add("ReturnNumber", std::vector<std::uint8_t>{1, 1, 1, 1});
  write_ply(folder / "0.ply", cloud);
  const auto source = open(folder.path());
  const auto scan = read_scans(*source).at(0);
  EXPECT_THAT(scan->intensity, ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(scan->time, ElementsAre(0, FloatNear(0.03F, 1e-6F), FloatNear(0.06F, 1e-6F),
                                      FloatNear(0.09F, 1e-6F)));
  EXPECT_EQ(fact_value(*source, "point fields not used"), "ReturnNumber");
}

/// Two rows of three points, of two elevations.
std::string organised_pcd(const std::string& elevations) {
  std::string text = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
  text += "WIDTH 3\nHEIGHT 2\nPOINTS 6\nDATA ascii\n";
  for (const char elevation : elevations) {
    text += fmt::format("10 {} {}\n", static_cast<int>(text.size() % 3), elevation);
  }
  return text;
}

TEST(PointFields, RowsOfAnOrganisedCloudAreRingsWhereTheyLookLikeThem) {
  const TemporaryFolder folder;
  files::write_text(folder / "0.pcd", organised_pcd("111555"));
  const auto source = open(folder.path());
  EXPECT_THAT(read_scans(*source).at(0)->ring, ElementsAre(0, 0, 0, 1, 1, 1));
  EXPECT_THAT(fact_value(*source, "ring field"), HasSubstr("rows"));
  files::write_text(folder / "0.pcd", organised_pcd("151515"));
  const auto other = open(folder.path());
  EXPECT_THAT(read_scans(*other).at(0)->ring, IsEmpty());
}

TEST(PointFields, AFieldThatIsNotNeededMakesNoScanUnusable) {
  const TemporaryFolder folder;
  files::write_text(folder / "0.pcd",
                    "VERSION 0.7\nFIELDS x y z label half\nSIZE 4 4 4 4 2\nTYPE F F F U F\n"
                    "COUNT 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n"
                    "1 2 3 car 0.5\n4 5 6 -1 0.5\n");
  files::write_text(folder / "1.pcd",
                    "VERSION 0.7\nFIELDS x y z half\nSIZE 4 4 4 2\nTYPE F F F F\n"
                    "COUNT 1 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA binary\n" +
                        std::string(14, '\x3f'));
  const auto source = open(folder.path());
  const auto scans = read_scans(*source);
  ASSERT_THAT(scans, SizeIs(2));
  EXPECT_THAT(scans[0]->x, ElementsAre(1, 4));
  EXPECT_THAT(scans[1]->z, Each(FloatNear(0.747F, 0.001F)));
}

TEST(PointFields, RingNumbersThatNobodyNeedsMakeNoScanUnusable) {
  const auto bad_rings = [](PointCloud& cloud, std::size_t i) {
    cloud.add("ring", std::vector<float>{0, 1, i == 1 ? -1.0F : 2.0F, 3});
  };
  const Drive needed(bad_rings);
  EXPECT_THAT(needed.scans(), SizeIs(kScans - 1));
  const Drive not_needed(bad_rings, {"lidar.ring_source=storage_order"});
  EXPECT_THAT(not_needed.scans(), SizeIs(kScans));
}

}  // namespace
}  // namespace traverse::dataset
