#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/bags/container_writer.hpp"
#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

#include "temporary_folder.hpp"

// Trajectories as programs leave them behind beyond TUM, KITTI and EuRoC: tables with names of
// their columns, pose graphs, topics of bags.
namespace traverse::dataset {
namespace {

using geometry::Pose3;
using geometry::Trajectory;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

Trajectory read_table(const std::string& text, const TrajectoryChoice& choice,
                      TrajectoryReading* reading = nullptr) {
  const TemporaryFolder folder;
  files::write_text(folder / "t.csv", text);
  return read_trajectory(folder / "t.csv", choice, reading);
}

/// Place, expectation and finding of the error.
std::string refusal_of(const std::string& text, const TrajectoryChoice& choice) {
  try {
    read_table(text, choice);
  } catch (const files::InputError& error) {
    return error.place().text + ": " + error.expected() + " | " + error.found();
  }
  return "read";
}

const Pose3 kQuarterTurn{(Eigen::Matrix3d() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished(), {1, 2, 3}};

void expect_quarter_turn(const Trajectory& read, std::int64_t ns) {
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read.stamp(0).nanoseconds, ns);
  EXPECT_TRUE(read.pose(0).matrix().isApprox(kQuarterTurn.matrix(), 1e-15));
}

TEST(NamedColumns, AHeaderTellsThemInAnyOrder) {
  const std::string q = "0.7071067811865476";
  const std::int64_t ns = 1317042145123456789;
  expect_quarter_turn(read_table("timestamp,qw,qx,qy,qz,x,y,z,status\n1317042145.123456789," + q +
                                     ",0,0," + q + ",1,2,3,ok\n",
                                 {}),
                      ns);
  expect_quarter_turn(read_table("# made by a program\n# stamp_ns; tx; ty; tz; qx; qy; qz; qw\n"
                                 "1317042145123456789; 1; 2; 3; 0; 0; " +
                                     q + "; " + q + "\n",
                                 {TrajectoryFormat::kCsv}),
                      ns);
  expect_quarter_turn(
      read_table("Time[ms] p_x p_y p_z q_x q_y q_z q_w\n2500 1 2 3 0 0 " + q + " " + q + "\n", {}),
      2'500'000'000);
}

TEST(NamedColumns, RostopicsTablesAreRead) {
  expect_quarter_turn(
      read_table("%time,field.header.seq,field.header.stamp,field.pose.pose.position.x,"
                 "field.pose.pose.position.y,field.pose.pose.position.z,"
                 "field.pose.pose.orientation.x,field.pose.pose.orientation.y,"
                 "field.pose.pose.orientation.z,field.pose.pose.orientation.w\n"
                 "1500000000500000000,7,1500000000000000000,1,2,3,0,0,0.7071067811865476,"
                 "0.7071067811865476\n",
                 {}),
      1500000000000000000);
}

TEST(NamedColumns, TheUserMayNameThem) {
  const std::string q = "0.7071067811865476";
  expect_quarter_turn(read_table("9,2500,1,2,3,0,0," + q + "," + q + "\n",
                                 {TrajectoryFormat::kAuto, "_,t_ms,x,y,z,qx,qy,qz,qw"}),
                      2'500'000'000);
  expect_quarter_turn(
      read_table("when,east,north,up,a,b,c,d\n2.5,1,2,3,0,0," + q + "," + q + "\n",
                 {TrajectoryFormat::kAuto, "t=when,x=east,y=north,z=up,qx=a,qy=b,qz=c,qw=d"}),
      2'500'000'000);
}

TEST(NamedColumns, WhatIsMissingIsNamed) {
  const TrajectoryChoice csv{TrajectoryFormat::kCsv};
  EXPECT_EQ(refusal_of("t,x,y,z,qx,qy,qz\n1,0,0,0,0,0,0\n", csv),
            "line 1: a header that names the columns t, x, y, z, qx, qy, qz and qw (or --columns) "
            "| no qw in 't,x,y,z,qx,qy,qz'");
  EXPECT_THAT(refusal_of("1,0,0,0,0,0,0,1\n", csv), HasSubstr("(or --columns) | numbers"));
  EXPECT_EQ(refusal_of("t,x,y,z,qx,qy,qz,qw\n1,0,0,0,0,0,0\n", csv), "line 2: 8 columns | 7");
  EXPECT_EQ(refusal_of("t,x,y,z,qx,qy,qz,qw\n1,0,0,a,0,0,0,1\n", csv),
            "line 2: a finite number | 'a'");
  EXPECT_THAT(refusal_of("1,0,0,0,0,0,0,1\n", {TrajectoryFormat::kCsv, "t,x,y,z,qx,qy,qz,_"}),
              HasSubstr("| 't,x,y,z,qx,qy,qz,_' without qw"));
  EXPECT_THAT(refusal_of("1,0,0,0,0,0,0,1\n", {TrajectoryFormat::kCsv, "t,x,y,z,qx,qy,qz,wq"}),
              HasSubstr("| 'wq'"));
  EXPECT_THAT(refusal_of("a,b\n1,0\n", {TrajectoryFormat::kCsv, "t=c"}),
              HasSubstr("| 't=c'; the file's header names a, b"));
  EXPECT_EQ(refusal_of("# nothing\n", csv), ": at least one pose | none");
}

TEST(PoseGraphs, VerticesComeInTheOrderOfTheirIds) {
  TrajectoryReading reading;
  const Trajectory read = read_table(
      "EDGE_SE3:QUAT 0 2 1 0 0 0 0 0 1\nVERTEX_SE3:QUAT 2 1 2 3 0 0 0.7071067811865476 "
      "0.7071067811865476\nVERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n",
      {}, &reading);
  EXPECT_EQ(reading.format, TrajectoryFormat::kG2o);
  EXPECT_FALSE(read.is_stamped());
  EXPECT_THAT(reading.frame_numbers, ElementsAre(0, 2));
  EXPECT_TRUE(read.pose(1).matrix().isApprox(kQuarterTurn.matrix(), 1e-15));
  // GTSAM's key x3.
  read_table("VERTEX_SE3:QUAT 8646911284551352323 0 0 0 0 0 0 1\n", {}, &reading);
  EXPECT_THAT(reading.frame_numbers, ElementsAre(3));
}

TEST(PoseGraphs, WhatIsNoPoseInSpaceIsNamed) {
  EXPECT_THAT(refusal_of("VERTEX_SE2 0 0 0 0\n", {}), HasSubstr("'VERTEX_SE2', which are in the "));
  EXPECT_EQ(refusal_of("VERTEX_SE3:QUAT 0 0 0 0 0 0 1\n", {}),
            "line 1: VERTEX_SE3:QUAT id x y z qx qy qz qw | 8 words");
  EXPECT_EQ(refusal_of("VERTEX_SE3:QUAT -1 0 0 0 0 0 0 1\n", {}),
            "line 1: an id, a whole number from 0 on | '-1'");
  EXPECT_EQ(refusal_of("EDGE_SE3:QUAT 0 2 1 0 0 0 0 0 1\n", {}), ": at least one pose | none");
  EXPECT_THAT(refusal_of("VERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\n", {}),
              HasSubstr("two with the id 1"));
}

/// A bag with two topics of poses, one pose each; the second tells a quarter of a turn.
void write_pose_bag(const std::filesystem::path& file, bool ros1) {
  std::ofstream stream(file, std::ios::binary);
  const auto writer = ros1 ? bags::write_ros1_bag(stream, bags::ChunkPacking::kNone)
                           : bags::write_mcap(stream, bags::ChunkPacking::kNone);
  for (const auto& [topic, turn] : {std::pair{"/wheels", 0.0}, std::pair{"/estimate", 1.0}}) {
    const std::size_t channel = writer->add_channel(topic, "nav_msgs/Odometry", false);
    bags::MessageWriter message(writer->wire());
    const double half = turn * 0.7071067811865476;
    message.header(1'500'000'000, "map").text("base").f64(1).f64(2).f64(3);
    message.f64(0).f64(0).f64(half).f64(turn == 0 ? 1 : half);
    message.zeros(36).zeros(6).zeros(36);
    writer->add(channel, 2'000'000'000, message.take());
  }
  writer->finish();
}

TEST(PoseTopics, ABagGivesThePosesOfTheTopicThatIsNamed) {
  const TemporaryFolder folder;
  for (const bool ros1 : {true, false}) {
    const auto file = folder / (ros1 ? "a.bag" : "a.mcap");
    write_pose_bag(file, ros1);
    TrajectoryReading reading;
    expect_quarter_turn(read_trajectory(file, {TrajectoryFormat::kAuto, "", "/estimate"}, &reading),
                        1'500'000'000);
    EXPECT_THAT(describe(reading), HasSubstr("topic /estimate (nav_msgs/Odometry)"));
    for (const auto& [topic, found] :
         {std::pair{"", "/wheels (nav_msgs/Odometry), /estimate (nav_msgs/Odometry)"},
          std::pair{"/other", "topics with poses: /wheels"}}) {
      try {
        read_trajectory(file, {TrajectoryFormat::kAuto, "", topic});
        ADD_FAILURE() << topic;
      } catch (const files::InputError& error) {
        EXPECT_THAT(error.found(), HasSubstr(found));
      }
    }
  }
}

}  // namespace
}  // namespace traverse::dataset
