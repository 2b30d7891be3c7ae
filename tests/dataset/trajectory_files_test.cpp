#include "traverse/dataset/trajectory_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "geometry/random_motion.hpp"
#include "temporary_folder.hpp"

namespace traverse::dataset {
namespace {

using geometry::Pose3;
using geometry::Stamp;
using geometry::Trajectory;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::RandomMotion;
using testing::TemporaryFolder;

double largest_difference(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

Trajectory random_trajectory(unsigned seed, bool with_products) {
  RandomMotion random(seed);
  Trajectory trajectory;
  for (std::int64_t i = 0; i < 2000; ++i) {
    Pose3 pose = random.pose(std::numbers::pi, 1000);
    for (int factor = 0; with_products && factor < 2; ++factor) pose = pose * random.pose(1, 1);
    trajectory.push_back(Stamp{1317042145123456789 + 100'000'007 * i}, pose);
  }
  return trajectory;
}

Trajectory read_text_as(const std::string& text, TrajectoryFormat format) {
  const TemporaryFolder folder;
  files::write_text(folder / "t.txt", text);
  return read_trajectory(folder / "t.txt", format);
}

/// Line, expectation and finding of the error, without the folder.
std::string message_of(const std::string& text, TrajectoryFormat format) {
  try {
    read_text_as(text, format);
  } catch (const files::InputError& error) {
    return error.place().text + ": " + error.expected() + " | " + error.found();
  }
  return "no error";
}

class QuaternionFiles : public ::testing::TestWithParam<std::string> {
 protected:
  static Trajectory round_trip(const Trajectory& trajectory) {
    const TemporaryFolder folder;
    (GetParam() == "tum" ? write_tum : write_euroc)(folder / "t.txt", trajectory);
    EXPECT_EQ(name_of(detect_trajectory_format(folder / "t.txt")), GetParam());
    return read_trajectory(folder / "t.txt", TrajectoryFormat::kAuto);
  }
};

TEST_P(QuaternionFiles, KeepStampsPositionsAndRotations) {
  for (const bool with_products : {false, true}) {
    const Trajectory written = random_trajectory(1, with_products);
    const Trajectory once = round_trip(written);
    const Trajectory twice = round_trip(once);
    EXPECT_EQ(once.stamps(), written.stamps());
    ASSERT_EQ(twice.size(), written.size());
    for (std::size_t i = 0; i < written.size(); ++i) {
      const Eigen::Matrix3d& R = written.pose(i).rotation;
      EXPECT_EQ(once.pose(i).translation, written.pose(i).translation);
      EXPECT_LE(largest_difference(once.pose(i).rotation, R),
                4e-16 + largest_difference(R * R.transpose(), Eigen::Matrix3d::Identity()));
      EXPECT_LE(largest_difference(twice.pose(i).rotation, once.pose(i).rotation), 2.3e-16);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(TrajectoryFiles, QuaternionFiles, ::testing::Values("tum", "euroc"));

TEST(TrajectoryFiles, KittiKeepsAllTwelveNumbers) {
  const TemporaryFolder folder;
  Trajectory written = Trajectory::unstamped(random_trajectory(2, true).poses());
  write_kitti(folder / "t.txt", written);
  EXPECT_EQ(detect_trajectory_format(folder / "t.txt"), TrajectoryFormat::kKitti);
  const Trajectory read = read_trajectory(folder / "t.txt", TrajectoryFormat::kAuto);
  EXPECT_FALSE(read.is_stamped());
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    EXPECT_EQ(read.pose(i).rotation, written.pose(i).rotation);
    EXPECT_EQ(read.pose(i).translation, written.pose(i).translation);
  }
}

TEST(TrajectoryFiles, TheWrittenTextIsWhatOtherToolsRead) {
  const TemporaryFolder folder;
  Trajectory trajectory;
  trajectory.push_back(
      Stamp{1'500'000'000},
      {(Eigen::Matrix3d() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished(), {1, -2.5, 3}});
  write_tum(folder / "tum", trajectory);
  EXPECT_EQ(files::read_text(folder / "tum"),
            "1.500000000 1 -2.5 3 0 0 0.7071067811865476 0.7071067811865476\n");
  write_kitti(folder / "kitti", trajectory);
  EXPECT_EQ(files::read_text(folder / "kitti"), "0 -1 0 1 1 0 0 -2.5 0 0 1 3\n");
  write_euroc(folder / "euroc", trajectory);
  EXPECT_THAT(files::read_text(folder / "euroc"),
              HasSubstr("\n1500000000,1,-2.5,3,0.7071067811865476,0,0,0.7071067811865476\n"));
}

TEST(TrajectoryFiles, ReadsTheColumnsOfEachFormat) {
  const Pose3 quarter_turn{(Eigen::Matrix3d() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished(), {1, 2, 3}};
  const Trajectory tum =
      read_text_as("# x\n1317042145.123456789 1 2 3  0 0 0.7071067811865476 0.7071067811865476\n",
                   TrajectoryFormat::kAuto);
  EXPECT_EQ(tum.stamp(0).nanoseconds, 1317042145123456789);
  EXPECT_TRUE(tum.pose(0).matrix().isApprox(quarter_turn.matrix(), 1e-15));
  const Trajectory euroc = read_text_as(
      "#timestamp, p_RS_R_x [m], ...\n1403636580838555648, 1, 2, 3, 0.7071067811865476, 0, 0, "
      "0.7071067811865476, 0.5, 0.25\n",
      TrajectoryFormat::kAuto);
  EXPECT_EQ(euroc.stamp(0).nanoseconds, 1403636580838555648);
  EXPECT_TRUE(euroc.pose(0).matrix().isApprox(quarter_turn.matrix(), 1e-15));
  const Trajectory kitti = read_text_as("0 -1 0 1 1 0 0 2 0 0 1 3\n", TrajectoryFormat::kAuto);
  EXPECT_EQ(kitti.pose(0).matrix(), quarter_turn.matrix());
}

TEST(TrajectoryFiles, EqualStampsAreReadStampsThatGoBackAreNot) {
  EXPECT_EQ(read_text_as("1 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n", TrajectoryFormat::kTum).size(), 2U);
  EXPECT_EQ(message_of("1 0 0 0 0 0 0 1\n\n0.9 1 0 0 0 0 0 1\n", TrajectoryFormat::kTum),
            "line 3: a stamp not before the last one, 1.000000000 | 0.900000000");
  EXPECT_EQ(message_of("#h\n5,0,0,0,1,0,0,0\n4,0,0,0,1,0,0,0\n", TrajectoryFormat::kEuroc),
            "line 3: a stamp not before the last one, 0.000000005 | 0.000000004");
}

TEST(TrajectoryFiles, RefusesWhatIsNoPoseAndNamesTheLine) {
  const auto tum = TrajectoryFormat::kTum;
  const auto kitti = TrajectoryFormat::kKitti;
  const auto euroc = TrajectoryFormat::kEuroc;
  EXPECT_EQ(message_of("1 0 0 0 0 0 0\n", tum),
            "line 1: the 8 columns t x y z qx qy qz qw of a TUM file | 7");
  EXPECT_EQ(message_of("1 0 0 0 0 0 0 1\n2 0 0 nan 0 0 0 1\n", tum),
            "line 2: a finite number | 'nan'");
  EXPECT_EQ(message_of("1 0 0 0 0 0 0 inf\n", tum), "line 1: a finite number | 'inf'");
  EXPECT_EQ(message_of("1 0 0 1e999 0 0 0 1\n", tum), "line 1: a finite number | '1e999'");
  EXPECT_EQ(message_of("1 0 0 0 0 0 0 0\n", tum),
            "line 1: a quaternion of length 1 | one of length 0");
  EXPECT_EQ(message_of("x 0 0 0 0 0 0 1\n", tum), "line 1: a time in seconds, below 9.2e9 | 'x'");
  EXPECT_EQ(message_of("1 2 3\n", kitti),
            "line 1: the 12 numbers of a 3x4 matrix of a KITTI file | 3");
  EXPECT_EQ(message_of("1 0 0 0 0 1 0 0 0 0 1 x\n", kitti), "line 1: a finite number | 'x'");
  EXPECT_EQ(message_of("2 0 0 0 0 2 0 0 0 0 2 0\n", kitti),
            "line 1: a rotation matrix in columns 1-3, 5-7, 9-11 | another matrix");
  EXPECT_EQ(message_of("1 0 0 0 0 1 0 0 0 0 -1 0\n", kitti),
            "line 1: a rotation matrix in columns 1-3, 5-7, 9-11 | another matrix");
  EXPECT_EQ(message_of("1,2,3\n", euroc),
            "line 1: at least the 8 columns t,x,y,z,qw,qx,qy,qz of a EuRoC file | 3");
  EXPECT_EQ(message_of("1.5,0,0,0,1,0,0,0\n", euroc),
            "line 1: a time in whole nanoseconds | '1.5'");
  EXPECT_EQ(message_of("5,0,0,0,0,0,0,0\n", euroc),
            "line 1: a quaternion of length 1 | one of length 0");
  EXPECT_EQ(message_of("1 0 0 0 1 2 3 0.5\n", tum),
            "line 1: a quaternion of length 1 | one of length 3.775");
  EXPECT_EQ(message_of("5,0,0,0,0.8,0,0,0\n", euroc),
            "line 1: a quaternion of length 1 | one of length 0.8");
  EXPECT_EQ(message_of("# only a comment\n", tum), ": at least one pose | none");
  EXPECT_EQ(message_of("", TrajectoryFormat::kAuto), ": at least one pose | none");
  EXPECT_THAT(message_of("1 2 3\n", TrajectoryFormat::kAuto), HasSubstr("line 1: a pose with 8"));
}

TEST(TrajectoryFiles, TimesOfAnotherUnitAreNamed) {
  EXPECT_EQ(
      message_of("1700000000000000000 0 0 0 0 0 0 1\n", TrajectoryFormat::kTum),
      "line 1: a time in seconds, below 9.2e9 | '1700000000000000000', nanoseconds if it is a "
      "Unix time: write seconds, or a EuRoC file, whose times are nanoseconds (commas between, "
      "w before x y z)");
  EXPECT_THAT(message_of("1.7e+15 0 0 0 0 0 0 1\n", TrajectoryFormat::kTum),
              HasSubstr("'1.7e+15', microseconds if it is"));
  EXPECT_EQ(
      message_of("1700000000.1,0,0,0,1,0,0,0\n", TrajectoryFormat::kAuto),
      "line 1: a time in whole nanoseconds | '1700000000.1', seconds if it is a Unix time: "
      "write nanoseconds, or a TUM file, whose times are seconds (blanks between, w after x y "
      "z)");
}

TEST(TrajectoryFiles, EurocTimesMayBeWrittenAsFloatingPointNumbers) {
  const std::string rest = ",0,0,0,1,0,0,0\n";
  for (const std::string time : {"1700000000100000000", "1.700000000100000000e+18",
                                 "1.7000000001E18", "1700000000100000000.0"}) {
    EXPECT_EQ(read_text_as(time + rest, TrajectoryFormat::kAuto).stamp(0).nanoseconds,
              1700000000100000000)
        << time;
  }
}

TrajectoryReading reading_of(const std::string& text) {
  const TemporaryFolder folder;
  files::write_text(folder / "t.txt", text);
  TrajectoryReading reading;
  read_trajectory(folder / "t.txt", TrajectoryFormat::kAuto, &reading);
  return reading;
}

TEST(TrajectoryFiles, SaysAsWhatAFileWasReadAndWhy) {
  EXPECT_EQ(describe(reading_of("1 0 0 0 0 0 0 1\n")), "TUM, 8 columns between blanks");
  EXPECT_EQ(describe(reading_of("1 0 0 0 0 1 0 0 0 0 1 0\n")), "KITTI, 12 columns between blanks");
  EXPECT_EQ(describe(reading_of("5,0,0,0,1,0,0,0\n")), "EuRoC, commas between the columns");
}

TEST(TrajectoryFiles, QuaternionsNearlyOfLengthOneAreNormalisedWithANote) {
  EXPECT_THAT(reading_of("1 0 0 0 0 0 0.707 0.708\n").notes, ::testing::IsEmpty());
  EXPECT_THAT(reading_of("1 0 0 0 0 0 0 0.95\n2 0 0 0 0 0 0 1.05\n3 0 0 0 0 0 0 1\n").notes,
              ElementsAre("2 quaternions of length 0.95 to 1.05 were normalised"));
  EXPECT_THAT(reading_of("5,0,0,0,1.02,0,0,0\n").notes,
              ElementsAre("1 quaternion of length 1.02 to 1.02 was normalised"));
}

TEST(TrajectoryFiles, FrameNumbersMayStandBeforeTheMatrix) {
  const std::string pose = " 1 0 0 4 0 1 0 5 0 0 1 6\n";
  const TrajectoryReading reading = reading_of("0" + pose + "1" + pose + "7" + pose);
  EXPECT_EQ(describe(reading), "KITTI, 12 columns after a frame number");
  EXPECT_THAT(reading.frame_numbers, ElementsAre(0, 1, 7));
  EXPECT_EQ(read_text_as("3" + pose, TrajectoryFormat::kKitti).pose(0).translation,
            Eigen::Vector3d(4, 5, 6));
  EXPECT_THAT(reading_of("0.000000000e+00" + pose + "1.2e1" + pose).frame_numbers,
              ElementsAre(0, 12));
  const auto kitti = TrajectoryFormat::kKitti;
  EXPECT_EQ(message_of("2" + pose + "2" + pose, kitti), "line 2: a frame number from 3 on | '2'");
  EXPECT_EQ(message_of("0.5" + pose, kitti), "line 1: a frame number from 0 on | '0.5'");
  EXPECT_EQ(message_of("0" + pose + pose, kitti),
            "line 2: a frame number and the 12 numbers of a 3x4 matrix of a KITTI file | 12");
}

/// A drive along a curve with hills, its quaternions in that order of columns.
std::string drive(const std::string& separator, bool is_w_first, double turn, std::size_t poses) {
  std::string text;
  Pose3 pose;
  for (std::size_t i = 0; i < poses; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(poses);
    Eigen::Quaterniond q(Eigen::AngleAxisd(turn * s, Eigen::Vector3d::UnitZ()) *
                         Eigen::AngleAxisd(0.1 * std::sin(20 * s), Eigen::Vector3d::UnitY()));
    pose.translation += q * Eigen::Vector3d(0.5, 0, 0);
    const Eigen::Vector3d t = pose.translation + 0.02 * Eigen::Vector3d::Random();
    std::vector<double> numbers{t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
    if (is_w_first) std::rotate(numbers.begin() + 3, numbers.begin() + 6, numbers.end());
    text += separator == "," ? std::to_string(1700000000000000000 + 100000000 * i)
                             : std::to_string(1700000000 + 0.1 * static_cast<double>(i));
    for (const double number : numbers) text += separator + std::to_string(number);
    text += "\n";
  }
  return text;
}

TEST(TrajectoryFiles, UnixTimesMayStandBeforeTheMatrix) {
  const testing::TemporaryFolder folder;
  files::write_text(folder / "global_pose.csv",
                    "1567496784952532897,1,0,0,350000.5,0,1,0,4000000,0,0,1,20\n"
                    "1567496784962532897,1,0,0,350001,0,1,0,4000000,0,0,1,20\n");
  TrajectoryReading reading;
  const Trajectory poses =
      read_trajectory(folder / "global_pose.csv", TrajectoryFormat::kAuto, &reading);
  EXPECT_EQ(describe(reading), "KITTI, 12 columns after a time, commas between");
  ASSERT_EQ(poses.size(), 2U);
  ASSERT_TRUE(poses.is_stamped());
  EXPECT_EQ(poses.stamp(0).nanoseconds, 1567496784952532897);
  EXPECT_EQ(poses.pose(0).translation.x(), 350000.5);
  files::write_text(folder / "mixed.csv",
                    "1567496784952532897,1,0,0,0,0,1,0,0,0,0,1,0\n7,1,0,0,0,0,1,0,0,0,0,1,0\n");
  EXPECT_THROW(read_trajectory(folder / "mixed.csv", TrajectoryFormat::kAuto), files::InputError);
}

TEST(TrajectoryFiles, SecondsAndNanosecondsMayStandInTwoColumns) {
  const testing::TemporaryFolder folder;
  files::write_text(folder / "registered_poses.csv",
                    "#sec,nsec,x,y,z,qx,qy,qz,qw\n1583836591,182590976,1,2,3,0,0,0,1\n"
                    "1583836591,282613760,1,2,4,0,0,0,1\n");
  const Trajectory poses =
      read_trajectory(folder / "registered_poses.csv", TrajectoryFormat::kAuto);
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses.stamp(0).nanoseconds, 1583836591182590976);
  EXPECT_EQ(poses.stamp(1).nanoseconds, 1583836591282613760);
  files::write_text(folder / "bare.csv", "1583836591,182590976,1,2,3,0,0,0,1\n");
  const TrajectoryChoice named{TrajectoryFormat::kAuto, "sec,nsec,x,y,z,qx,qy,qz,qw", ""};
  EXPECT_EQ(read_trajectory(folder / "bare.csv", named).stamp(0).nanoseconds, 1583836591182590976);
  files::write_text(folder / "wrong.csv",
                    "sec,nsec,x,y,z,qx,qy,qz,qw\n1583836591,1182590976,1,2,3,0,0,0,1\n");
  EXPECT_THROW(read_trajectory(folder / "wrong.csv", TrajectoryFormat::kAuto), files::InputError);
}

TEST(TrajectoryFiles, QuaternionsInTheOtherOrderAreFound) {
  for (const double turn : {0.8, 3.0, -6.0}) {
    for (const std::size_t poses : {120U, 3000U}) {
      const TrajectoryReading euroc = reading_of(drive(",", false, turn, poses));
      ASSERT_THAT(euroc.notes, ::testing::SizeIs(1)) << turn << " " << poses;
      EXPECT_THAT(euroc.notes[0], HasSubstr("taken as w x y z, the order of this format, but look "
                                            "like x y z w"));
      const TrajectoryReading tum = reading_of(drive(" ", true, turn, poses));
      ASSERT_THAT(tum.notes, ::testing::SizeIs(1)) << turn << " " << poses;
      EXPECT_THAT(tum.notes[0], HasSubstr("taken as x y z w, the order of this format, but look "
                                          "like w x y z"));
      EXPECT_THAT(reading_of(drive(",", true, turn, poses)).notes, ::testing::IsEmpty());
      EXPECT_THAT(reading_of(drive(" ", false, turn, poses)).notes, ::testing::IsEmpty());
    }
  }
  // Straight on nobody can tell, nor where a body moves to all sides.
  EXPECT_THAT(reading_of(drive(",", false, 0, 100)).notes, ::testing::IsEmpty());
  RandomMotion random(4);
  std::string wild;
  for (int i = 0; i < 500; ++i) {
    const Pose3 pose = random.pose(3, 100);
    const Eigen::Quaterniond q(pose.rotation);
    wild += std::to_string(i) + " " + std::to_string(pose.translation.x()) + " " +
            std::to_string(pose.translation.y()) + " " + std::to_string(pose.translation.z()) +
            " " + std::to_string(q.x()) + " " + std::to_string(q.y()) + " " +
            std::to_string(q.z()) + " " + std::to_string(q.w()) + "\n";
  }
  EXPECT_THAT(reading_of(wild).notes, ::testing::IsEmpty());
}

TEST(TrajectoryFiles, RefusesToWriteWhatCouldNotBeReadAndLeavesNothing) {
  const TemporaryFolder folder;
  const Trajectory unstamped = Trajectory::unstamped({Pose3()});
  EXPECT_THROW(write_tum(folder / "t", unstamped), std::invalid_argument);
  EXPECT_THROW(write_euroc(folder / "t", unstamped), std::invalid_argument);
  const Trajectory backward = Trajectory::stamped({Stamp{2}, Stamp{1}}, {Pose3(), Pose3()});
  EXPECT_THROW(write_tum(folder / "t", backward), std::invalid_argument);
  Pose3 broken;
  broken.translation.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_kitti(folder / "t", Trajectory::unstamped({broken})), std::invalid_argument);
  broken = Pose3();
  broken.rotation(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_kitti(folder / "t", Trajectory::unstamped({broken})), std::invalid_argument);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_THROW(write_tum(folder / "none" / "t", random_trajectory(3, false)), files::OutputError);
}

TEST(TrajectoryFiles, FormatsHaveNames) {
  EXPECT_EQ(name_of(TrajectoryFormat::kEuroc), "euroc");
  EXPECT_EQ(name_of(TrajectoryFormat::kG2o), "g2o");
  EXPECT_EQ(kTrajectoryFormatNames.size(), 7U);
}

}  // namespace
}  // namespace traverse::dataset
