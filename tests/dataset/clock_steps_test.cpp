#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/files/atomic_file.hpp"

#include "dataset/made_recordings.hpp"
#include "dataset/rawlog_maker.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using namespace traverse::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A kind of recording with one sensor whose records have these stamps.
struct Kind {
  std::string name;
  /// Writes the recording and returns its path.
  std::function<fs::path(const fs::path& folder, const std::vector<double>& seconds)> make;
  std::vector<std::string> statements = {};
};

constexpr double kEpoch_s = 1767225600;  // of made rawlogs

std::string lines_of(const std::vector<double>& seconds) {
  std::string text;
  for (const double s : seconds) text += fmt::format("{:.6f}\n", s + kEpoch_s);
  return text;
}

fs::path make_kitti(const fs::path& folder, const std::vector<double>& seconds) {
  make_kitti_folder(folder, seconds.size());
  files::write_text(folder / "times.txt", lines_of(seconds));
  return folder;
}

fs::path make_clouds(const fs::path& folder, const std::vector<double>& seconds) {
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    PointCloud cloud;
    for (const char* name : {"x", "y", "z"}) cloud.add(name, std::vector<float>{1, 2, 3});
    write_pcd(folder / fmt::format("{:06}.pcd", i), cloud);
  }
  files::write_text(folder / "times.txt", lines_of(seconds));
  return folder;
}

fs::path make_log(const fs::path& folder, const std::vector<double>& seconds) {
  std::string text;
  for (const double s : seconds) text += fmt::format("IMU {:.6f} 0 0 0 0 0 9.8\n", s + kEpoch_s);
  files::write_text(folder / "log.txt", text);
  return folder / "log.txt";
}

fs::path make_csv(const fs::path& folder, const std::vector<double>& seconds) {
  std::string text = "t,gx,gy,gz,ax,ay,az\n";
  for (const double s : seconds) text += fmt::format("{:.6f},0,0,0,0,0,9.8\n", s + kEpoch_s);
  files::write_text(folder / "imu.csv", text);
  return folder;
}

fs::path make_rawlog(const fs::path& folder, const std::vector<double>& seconds, bool are_scans) {
  RawlogMaker maker(folder / "a.rawlog");
  for (const double s : seconds) {
    if (are_scans) {
      maker.add(made_velodyne(s));
    } else {
      maker.add(made_imu(s));
    }
  }
  return folder / "a.rawlog";
}

class ClockOf : public ::testing::TestWithParam<Kind> {
 protected:
  /// A sensor of 10 Hz.
  static std::vector<double> regular(std::size_t records) {
    std::vector<double> seconds;
    for (std::size_t i = 0; i < records; ++i) seconds.push_back(0.1 * static_cast<double>(i));
    return seconds;
  }
  /// Milliseconds of what a recording with these stamps gives, from kEpoch_s on.
  std::vector<std::int64_t> read(const std::vector<double>& seconds) {
    folder_ = std::make_unique<TemporaryFolder>();
    source_ = open(GetParam().make(folder_->path(), seconds), GetParam().statements);
    std::vector<std::int64_t> milliseconds;
    for (const auto& measurement : read_all(*source_)) {
      milliseconds.push_back(
          std::llround(1e3 * (sensors::stamp_of(measurement).seconds() - kEpoch_s)));
    }
    return milliseconds;
  }
  std::size_t skipped() const { return source_->skipped().total(); }
  std::vector<Fact> steps() const {
    std::vector<Fact> found;
    for (const Fact& fact : source_->info().facts) {
      const bool is_step =
          fact.name == "clock set back" || fact.name == "a pause, or clock set forward";
      if (is_step) found.push_back(fact);
    }
    return found;
  }

  std::unique_ptr<TemporaryFolder> folder_;
  std::unique_ptr<Source> source_;
};

std::vector<std::int64_t> every_100_ms(std::size_t count) {
  std::vector<std::int64_t> milliseconds;
  for (std::size_t i = 0; i < count; ++i)
    milliseconds.push_back(static_cast<std::int64_t>(100 * i));
  return milliseconds;
}

TEST_P(ClockOf, OneStampFarOffCostsOneRecord) {
  for (const double off : {1e5, 3600.0, -3600.0}) {
    for (const std::size_t at : {0U, 1U, 8U, 22U, 23U}) {
      auto seconds = regular(24);
      seconds[at] += off;
      auto expected = every_100_ms(24);
      expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(at));
      EXPECT_EQ(read(seconds), expected) << off << " at " << at;
      EXPECT_EQ(skipped(), 1U) << off << " at " << at;
      EXPECT_THAT(steps(), IsEmpty()) << off << " at " << at;
    }
  }
}

TEST_P(ClockOf, SetBackGoesOnAsANewSegment) {
  for (const double back : {2.0, 100.0, 1e6}) {
    auto seconds = regular(24);
    for (std::size_t i = 12; i < 24; ++i) seconds[i] -= back;
    EXPECT_EQ(read(seconds), every_100_ms(24)) << back;
    EXPECT_EQ(skipped(), 0U);
    ASSERT_THAT(steps(), SizeIs(1)) << back;
    EXPECT_EQ(steps()[0].name, "clock set back");
    EXPECT_THAT(steps()[0].value, HasSubstr(fmt::format("by {:.3f} s, from ", back - 0.1)));
    EXPECT_THAT(steps()[0].reason, HasSubstr("moved by"));
    // Read once more it is the same, and said once.
    source_->rewind();
    EXPECT_THAT(read_all(*source_), SizeIs(24));
    EXPECT_THAT(steps(), SizeIs(1));
  }
}

TEST_P(ClockOf, SetForwardOrAPauseIsANewSegment) {
  auto seconds = regular(24);
  for (std::size_t i = 12; i < 24; ++i) seconds[i] += 1e5;
  auto expected = every_100_ms(24);
  for (std::size_t i = 12; i < 24; ++i) expected[i] += 100'000'000;
  EXPECT_EQ(read(seconds), expected);
  EXPECT_EQ(skipped(), 0U);
  ASSERT_THAT(steps(), SizeIs(1));
  EXPECT_THAT(steps()[0].value, HasSubstr("by 100000.100 s, from "));
  // A pause as recordings have them is none.
  seconds = regular(24);
  for (std::size_t i = 12; i < 24; ++i) seconds[i] += 20;
  EXPECT_THAT(read(seconds), SizeIs(24));
  EXPECT_THAT(steps(), IsEmpty());
}

TEST_P(ClockOf, SetBackAndRightAgain) {
  auto seconds = regular(36);
  for (std::size_t i = 12; i < 24; ++i) seconds[i] -= 100;
  const auto read_ms = read(seconds);
  EXPECT_THAT(read_ms, SizeIs(36));
  EXPECT_TRUE(std::is_sorted(read_ms.begin(), read_ms.end()));
  EXPECT_EQ(skipped(), 0U);
}

INSTANTIATE_TEST_SUITE_P(
    Recordings, ClockOf,
    ::testing::Values(Kind{"kitti", make_kitti}, Kind{"clouds", make_clouds}, Kind{"log", make_log},
                      Kind{"csv",
                           make_csv,
                           {"csv.gyro={file: imu.csv, columns: gx gy gz}",
                            "csv.accelerometer={file: imu.csv, columns: ax ay az}"}},
                      Kind{"rawlog_scans",
                           [](const fs::path& folder, const std::vector<double>& seconds) {
                             return make_rawlog(folder, seconds, true);
                           }},
                      Kind{"rawlog_imu",
                           [](const fs::path& folder, const std::vector<double>& seconds) {
                             return make_rawlog(folder, seconds, false);
                           }}),
    [](const auto& kind) { return kind.param.name; });

// The KITTI layout takes the stamps of its poses from the same lines.
TEST(ClockSteps, PosesByNumberGoWithTheirScans) {
  const TemporaryFolder folder;
  std::vector<double> seconds;
  for (int i = 0; i < 24; ++i) seconds.push_back(0.1 * i);
  seconds[8] += 1e5;
  for (std::size_t i = 16; i < 24; ++i) seconds[i] -= 50;
  make_kitti(folder.path(), seconds);
  std::string poses;
  for (int i = 0; i < 24; ++i) poses += fmt::format("1 0 0 {} 0 1 0 0 0 0 1 0\n", i);
  files::write_text(folder / "poses.txt", poses);
  files::write_text(folder / "calib.txt", "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
  const auto source = open(folder.path());
  EXPECT_THAT(read_scans(*source), SizeIs(23));
  ASSERT_TRUE(source->reference());
  const auto& T_map_body = source->reference()->T_map_body;
  ASSERT_EQ(T_map_body.size(), 23U);
  for (std::size_t i = 0; i < T_map_body.size(); ++i) {
    const double number = T_map_body.pose(i).translation.x();
    EXPECT_NEAR(T_map_body.stamp(i).seconds() - kEpoch_s, 0.1 * number, 1e-5);
  }
}

/// A rawlog of an IMU at 100 Hz, a lidar at 10 Hz and fixes at 1 Hz (here a second IMU), as
/// recorded; `stamp` tells what the logger's clock says of a time.
std::vector<sensors::Measurement> three_sensors(const std::function<double(double)>& stamp,
                                                std::unique_ptr<Source>& source) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    for (int i = 0; i < 1000; ++i) {
      const double t = 0.01 * i;
      maker.add(made_imu(stamp(t)));
      if (i % 10 == 5) maker.add(made_velodyne(stamp(t - 0.04)));
      if (i % 100 == 31) maker.add(made_imu(stamp(t), "slow"));
    }
  }
  source = open(folder / "a.rawlog");
  return read_all(*source);
}

TEST(ClockSteps, SensorsOfARawlogStayTogetherWhenItsClockIsSetBack) {
  for (const double back : {0.5, 3.0, 1000.0}) {
    std::unique_ptr<Source> source;
    const auto all = three_sensors([&](double t) { return t < 5 ? t : t - back; }, source);
    EXPECT_THAT(skipped_in(*source), IsEmpty()) << back;
    ASSERT_THAT(all, SizeIs(1110)) << back;
    // What was recorded at one moment still is: all in the order in which it was made.
    std::map<std::string, std::vector<double>> seconds;
    for (const auto& measurement : all) {
      seconds[sensors::sensor_of(measurement)].push_back(sensors::stamp_of(measurement).seconds() -
                                                         kEpoch_s);
    }
    for (std::size_t i = 0; i < 1000; ++i) {
      EXPECT_NEAR(seconds["imu"].at(i), 0.01 * static_cast<double>(i), 0.011) << back;
    }
    for (std::size_t i = 0; i < 100; ++i) {
      EXPECT_NEAR(seconds["top"].at(i), 0.01 + 0.1 * static_cast<double>(i), 0.011) << back;
    }
    for (std::size_t i = 0; i < 10; ++i) {
      EXPECT_NEAR(seconds["slow"].at(i), 0.31 + static_cast<double>(i), 0.011) << back;
    }
  }
}

TEST(ClockSteps, OneWrongFixAmongOtherSensorsCostsItself) {
  for (const double off : {3600.0, -3600.0, 30.0, -30.0}) {
    const TemporaryFolder folder;
    {
      RawlogMaker maker(folder / "a.rawlog");
      for (int i = 0; i < 1000; ++i) {
        maker.add(made_imu(0.01 * i));
        if (i % 100 == 31) maker.add(made_imu(0.01 * i + (i == 431 ? off : 0), "slow"));
      }
    }
    const auto source = open(folder / "a.rawlog");
    EXPECT_THAT(read_all(*source), SizeIs(1009)) << off;
    EXPECT_EQ(source->skipped().total(), 1U) << off;
  }
}

// A receiver that is silent in a tunnel does not come back late.
TEST(ClockSteps, AfterAnOutageASlowSensorGoesOnAtOnce) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    for (int i = 0; i < 6000; ++i) {
      maker.add(made_imu(0.01 * i));
      const bool is_silent = i > 500 && i < 5000;
      if (i % 100 == 31 && !is_silent) maker.add(made_imu(0.01 * i, "slow"));
    }
  }
  const auto source = open(folder / "a.rawlog");
  const auto all = read_all(*source);
  EXPECT_TRUE(source->skipped().empty());
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return sensors::stamp_of(a) < sensors::stamp_of(b);
  }));
}

// Two sensors of one clock that pause now and then: the first to go on does not make the other
// late.
TEST(ClockSteps, AfterAPauseOfAllSensorsNothingIsLost) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    double t = 0;
    for (int i = 0; i < 200; ++i) {
      t += i % 17 == 16 ? 3.5 : 0.1;
      maker.add(made_imu(t));
      maker.add(made_imu(t, "second"));
    }
  }
  const auto source = open(folder / "a.rawlog");
  EXPECT_THAT(read_all(*source), SizeIs(400));
  EXPECT_THAT(skipped_in(*source), IsEmpty());
}

TEST(ClockSteps, ABookmarkAmongRecordsThatWaitGivesTheSame) {
  const TemporaryFolder folder;
  {
    RawlogMaker maker(folder / "a.rawlog");
    for (int i = 0; i < 40; ++i) maker.add(made_velodyne(0.1 * i - (i < 20 ? 0 : 100)));
  }
  const auto source = open(folder / "a.rawlog");
  const auto straight = made_stamps_of(read_all(*source));
  for (std::size_t k = 0; k < straight.size(); ++k) {
    source->rewind();
    for (std::size_t i = 0; i < k; ++i) source->next();
    const auto here = source->bookmark();
    read_all(*source);
    source->return_to(*here);
    const auto rest = made_stamps_of(read_all(*source));
    EXPECT_EQ(rest, std::vector<std::int64_t>(straight.begin() + static_cast<std::ptrdiff_t>(k),
                                              straight.end()))
        << k;
  }
}

}  // namespace
}  // namespace traverse::dataset
