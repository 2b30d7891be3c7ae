// Text as programs of all kinds write it: with a byte order mark, with carriage returns, in UTF-16.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "dataset/made_recordings.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

namespace fs = std::filesystem;
using namespace traverse::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr const char* kMark = "\xEF\xBB\xBF";

std::string with_carriage_returns(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return result;
}

std::string as_utf16(const std::string& text) {
  std::string result = "\xFF\xFE";
  for (const char c : text) result += {c, '\0'};
  return result;
}

/// The ways in which a text means the same.
std::vector<std::string> ways_of(const std::string& text) {
  return {text, kMark + text, with_carriage_returns(text), kMark + with_carriage_returns(text)};
}

TEST(TextKinds, KittiFoldersTakeAllOfTheirText) {
  std::string poses;
  for (int i = 0; i < 3; ++i) poses += "1 0 0 " + std::to_string(i) + " 0 1 0 0 0 0 1 0\n";
  const auto times = ways_of("0\n0.1\n0.2\n");
  const auto all_poses = ways_of(poses);
  const auto calibrations = ways_of("Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
  const auto statements = ways_of("name: Here\n");
  for (std::size_t way = 0; way < times.size(); ++way) {
    const TemporaryFolder folder;
    make_kitti_folder(folder.path(), 3);
    files::write_text(folder / "times.txt", times[way]);
    files::write_text(folder / "poses.txt", all_poses[way]);
    files::write_text(folder / "calib.txt", calibrations[way]);
    files::write_text(folder / "traverse.yaml", statements[way]);
    const auto source = open(folder.path());
    EXPECT_THAT(milliseconds_of(read_scans(*source)), ElementsAre(0, 100, 200)) << way;
    EXPECT_THAT(skipped_in(*source), IsEmpty()) << way;
    ASSERT_TRUE(source->reference()) << way;
    EXPECT_EQ(source->reference()->T_map_body.size(), 3U) << way;
    EXPECT_EQ(source->info().name, "Here") << way;
    for (const char* name : {"times.txt", "traverse.yaml"}) {
      const std::string text = files::read_text(folder / name);
      files::write_text(folder / name, as_utf16(text));
      EXPECT_THAT(opening_error(folder.path()), HasSubstr("found UTF-16 text; save it as UTF-8"));
      files::write_text(folder / name, text);
    }
  }
}

TEST(TextKinds, LogsTakeTheirFirstLine) {
  for (const std::string& text :
       ways_of("IMU 1 0 0 0 0 0 9.8\nODOM 1 0 0\nIMU 2 0 0 0 0 0 9.8\n")) {
    const TemporaryFolder folder;
    files::write_text(folder / "log.txt", text);
    const auto source = open(folder / "log.txt");
    EXPECT_THAT(read_all(*source), SizeIs(3));
    EXPECT_THAT(skipped_in(*source), IsEmpty());
    files::write_text(folder / "log.txt", as_utf16(text));
    EXPECT_THAT(opening_error(folder / "log.txt"), HasSubstr("found UTF-16 text"));
  }
}

TEST(TextKinds, CsvFilesTakeTheirHeader) {
  for (const std::string& text : ways_of("t,lat,lon,alt\n1,48,11,500\n2,48,11,500\n")) {
    const TemporaryFolder folder;
    files::write_text(folder / "gnss.csv", text);
    const std::vector<std::string> statements{"csv.gnss={file: gnss.csv, columns: lat lon alt}"};
    const auto source = open(folder.path(), statements);
    EXPECT_THAT(read_all(*source), SizeIs(2));
    files::write_text(folder / "gnss.csv", as_utf16(text));
    EXPECT_THAT(opening_error(folder.path(), statements), HasSubstr("found UTF-16 text"));
  }
}

TEST(TextKinds, TrajectoriesTakeTheirFirstPose) {
  for (const std::string text :
       {"1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 0\n",
        "#t,x\n1,0,0,0,1,0,0,0\n2,0,0,0,1,0,0,0\n"}) {
    for (const std::string& way : ways_of(text)) {
      const TemporaryFolder folder;
      files::write_text(folder / "a.txt", way);
      EXPECT_EQ(read_trajectory(folder / "a.txt", TrajectoryFormat::kAuto).size(), 2U);
      files::write_text(folder / "a.txt", as_utf16(way));
      try {
        read_trajectory(folder / "a.txt", TrajectoryFormat::kAuto);
        FAIL() << "not refused";
      } catch (const files::InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("found UTF-16 text; save it as UTF-8"));
      }
    }
  }
}

TEST(TextKinds, PointCloudsTakeTheirHeader) {
  const std::string pcd =
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
      "POINTS 2\nDATA ascii\n1 2 3\n4 5 6\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n1 2 3\n4 5 6\n";
  for (const std::string& text : {pcd, "# .PCD\n" + pcd, ply}) {
    for (const std::string& way : ways_of(text)) {
      const TemporaryFolder folder;
      files::write_text(folder / "a.pcd", way);
      EXPECT_EQ(read_point_cloud(folder / "a.pcd").size(), 2U);
      files::write_text(folder / "a.pcd", as_utf16(way));
      try {
        read_point_cloud(folder / "a.pcd");
        FAIL() << "not refused";
      } catch (const files::InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("found UTF-16 text; save it as UTF-8"));
      }
    }
  }
}

TEST(TextKinds, TimesFilesMayCountInNanoseconds) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 3);
  for (const auto& [text, form] :
       {std::pair("1700000000000000000\n1700000000100000000\n1700000000200000000\n", "nanoseconds"),
        std::pair("1.7000000000e+18\n1.7000000001e+18\n1.7000000002e+18\n", "nanoseconds"),
        std::pair("1700000000000000\n1700000000100000\n1700000000200000\n", "microseconds"),
        std::pair("1700000000000\n1700000000100\n1700000000200\n", "milliseconds")}) {
    files::write_text(folder / "times.txt", text);
    const auto source = open(folder.path());
    EXPECT_THAT(milliseconds_of(read_scans(*source)),
                ElementsAre(1700000000000, 1700000000100, 1700000000200));
    EXPECT_EQ(fact_value(*source, "scan stamps"),
              "times.txt (" + std::string(form) + ", told by their size)");
  }
}

constexpr const char* kImuStatements[] = {"csv.gyro={file: imu.csv, time: %, columns: gx gy gz}",
                                          "csv.accelerometer={file: imu.csv, time: %, columns: ax "
                                          "ay az}"};

std::vector<std::string> imu_statements(const std::string& time) {
  std::vector<std::string> statements;
  for (std::string statement : kImuStatements) {
    statements.push_back(statement.replace(statement.find('%'), 1, '"' + time + '"'));
  }
  return statements;
}

TEST(TextKinds, ACsvHeaderMayBeAComment) {
  for (const char* header :
       {"#t,gx,gy,gz,ax,ay,az", "# t, gx, gy, gz, ax, ay, az",
        "# made by a program\n#t,gx,gy,gz,ax,ay,az", "t [s],gx [rad/s],gy,gz,ax,ay,az",
        "\"t\",\"gx\",gy,gz,ax,ay,\"az\""}) {
    const TemporaryFolder folder;
    files::write_text(folder / "imu.csv",
                      header + std::string("\n1,0.1,0.2,0.3,0,0,9.8\n2,0.1,0.2,0.3,0,0,9.8\n"));
    for (const std::string time : {"t", "#t"}) {
      const auto source = open(folder.path(), imu_statements(time));
      EXPECT_THAT(read_all(*source), SizeIs(2)) << header;
      EXPECT_THAT(skipped_in(*source), IsEmpty()) << header;
    }
  }
  const TemporaryFolder folder;
  files::write_text(folder / "imu.csv", "#no header here\n1,2,3,4,5,6,7\n");
  EXPECT_THAT(opening_error(folder.path(), imu_statements("t")),
              HasSubstr("imu.csv, line 2: expected a column 't', found 1,2,3"));
}

constexpr const char* kEurocImu =
    "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m "
    "s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n"
    "1403636579758555392,-0.1,0.2,0.3,8.1,-0.3,-3.5\n"
    "1403636579763555584,-0.1,0.2,0.3,8.1,-0.3,-3.5\n";

TEST(TextKinds, EurocImuFilesOpenByTheirHeader) {
  const TemporaryFolder folder;
  files::write_text(folder / "data.csv", kEurocImu);
  const auto source = open(folder.path());
  const auto all = read_all(*source);
  ASSERT_THAT(all, SizeIs(2));
  const auto& sample = std::get<sensors::ImuSample>(all[0]);
  EXPECT_NEAR(sample.stamp.seconds(), 1403636579.758555392, 1e-6);
  EXPECT_NEAR(sample.angular_rate.x(), -0.1, 1e-12);
  EXPECT_NEAR(sample.specific_force.x(), 8.1, 1e-12);
  EXPECT_EQ(fact_reason(*source, "imu file"), "by the names of its columns");
  EXPECT_EQ(fact_value(*source, "data.csv, unit of the time"), "ns");
}

TEST(TextKinds, UnitsOfAHeaderHoldWhereNoneIsStated) {
  const TemporaryFolder folder;
  files::write_text(folder / "imu.csv",
                    "t [ms],gx [deg/s],gy [deg/s],gz [deg/s],ax,ay,az\n1500,180,0,0,0,0,9.8\n");
  auto statements = imu_statements("t");
  const auto source = open(folder.path(), statements);
  const auto sample = std::get<sensors::ImuSample>(read_all(*source).at(0));
  EXPECT_EQ(sample.stamp.nanoseconds, 1'500'000'000);
  EXPECT_NEAR(sample.angular_rate.x(), 3.14159265358979, 1e-12);
  EXPECT_EQ(fact_value(*source, "angular rates"), "deg/s");
  statements.insert(statements.end(), {"csv.time_unit_s=1", "csv.angular_rate=rad"});
  const auto stated =
      std::get<sensors::ImuSample>(read_all(*open(folder.path(), statements)).at(0));
  EXPECT_EQ(stated.stamp.nanoseconds, 1'500'000'000'000);
  EXPECT_EQ(stated.angular_rate.x(), 180);
  // Columns whose names hold blanks are told apart by commas.
  files::write_text(folder / "imu.csv", "time of day,lat of it,lon,alt\n1,48,11,500\n");
  const auto fixes =
      open(folder.path(),
           {"csv.gnss={file: imu.csv, time: time of day, columns: 'lat of it, lon, alt'}"});
  EXPECT_THAT(read_all(*fixes), SizeIs(1));
}

TEST(TextKinds, NanosecondsWhereSecondsAreExpectedAreNamed) {
  const TemporaryFolder folder;
  for (const auto& [time, unit, seconds] :
       {std::tuple("1700000000000000000", "nanoseconds", "1e-09"),
        {"1700000000000000", "microseconds", "1e-06"},
        {"1700000000000", "milliseconds", "0.001"}}) {
    const std::string row = std::string(time) + ",0,0,0,0,0,9.8\n";
    files::write_text(folder / "imu.csv", "t,gx,gy,gz,ax,ay,az\n" + row + row);
    EXPECT_THAT(
        opening_error(folder.path(), imu_statements("t")),
        HasSubstr("imu.csv, line 2: expected a time in seconds, since csv.time_unit_s is 1, "
                  "found '" +
                  std::string(time) + "', " + unit +
                  " if it is a Unix time; say so with --recording csv.time_unit_s=" + seconds));
    files::write_text(folder / "log.txt", "IMU " + std::string(time) + " 0 0 0 0 0 9.8\n");
    EXPECT_THAT(
        opening_error(folder / "log.txt"),
        HasSubstr("log.txt, line 1: expected a time in seconds, since log.time_unit_s is 1, "
                  "found '" +
                  std::string(time) + "', " + unit));
    EXPECT_EQ(opening_error(folder / "log.txt", {std::string("log.time_unit_s=") + seconds}),
              "no error");
  }
}

TEST(TextKinds, PosesWithFrameNumbersGoWithTheScansOfTheirNumbers) {
  const TemporaryFolder folder;
  make_kitti_folder(folder.path(), 4);
  files::write_text(folder / "calib.txt", "Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n");
  files::write_text(folder / "poses.txt",
                    "0 1 0 0 0 0 1 0 0 0 0 1 0\n2 1 0 0 2 0 1 0 0 0 0 1 0\n"
                    "3 1 0 0 3 0 1 0 0 0 0 1 0\n");
  const auto source = open(folder.path());
  ASSERT_TRUE(source->reference());
  const auto& T_map_body = source->reference()->T_map_body;
  ASSERT_EQ(T_map_body.size(), 3U);
  EXPECT_EQ(T_map_body.stamp(1).nanoseconds, 200'000'000);
  EXPECT_EQ(T_map_body.pose(1).translation.x(), 2);
  EXPECT_EQ(fact_reason(*source, "reference read as"), "as asked for, with frame numbers");
  files::write_text(folder / "poses.txt", "4 1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_THAT(fact_reason(*open(folder.path()), "reference"), HasSubstr("frame numbers below 4"));
}

}  // namespace
}  // namespace traverse::dataset
