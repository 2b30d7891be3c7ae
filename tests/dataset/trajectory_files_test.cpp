#include "traverse/dataset/trajectory_files.hpp"

#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

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
    if (with_products) pose = pose * random.pose(1, 1) * random.pose(1, 1);
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
      read_text_as("# x\n1317042145.123456789 1 2 3  0 0 2 2\n", TrajectoryFormat::kAuto);
  EXPECT_EQ(tum.stamp(0).nanoseconds, 1317042145123456789);
  EXPECT_TRUE(tum.pose(0).matrix().isApprox(quarter_turn.matrix(), 1e-15));
  const Trajectory euroc = read_text_as(
      "#timestamp, p_RS_R_x [m], ...\n1403636580838555648, 1, 2, 3, 1, 0, 0, 1, 0.5, 0.25\n",
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
  EXPECT_EQ(message_of("# only a comment\n", tum), ": at least one pose | none");
  EXPECT_EQ(message_of("", TrajectoryFormat::kAuto), ": at least one pose | none");
  EXPECT_THAT(message_of("1 2 3\n", TrajectoryFormat::kAuto), HasSubstr("line 1: a pose with 8"));
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
  EXPECT_EQ(kTrajectoryFormatNames.size(), 4U);
}

}  // namespace
}  // namespace traverse::dataset
