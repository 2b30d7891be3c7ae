#include "traverse/slam/slam.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "slam/made_drive.hpp"

namespace traverse::slam {
namespace {

using testing::MadeDrive;
using testing::MadeFrame;

SlamOptions options() {
  SlamOptions options;
  options.candidates.min_way_m = 25;
  return options;
}

Slam run(const MadeDrive& drive, const SlamOptions& options) {
  Slam slam(options, drive.profile());
  for (const MadeFrame& made : drive.frames()) {
    if (!slam.wants(made.frame)) continue;
    slam.add(made.frame, made.scan, testing::points_of(made, drive.profile()), true);
  }
  slam.finish();
  return slam;
}

std::vector<geometry::Pose3> corrected(const Slam& slam, const MadeDrive& drive) {
  std::vector<geometry::Stamp> stamps;
  std::vector<geometry::Pose3> poses;
  for (const MadeFrame& made : drive.frames()) {
    stamps.push_back(made.frame.stamp);
    poses.push_back(made.frame.T_map_lidar);
  }
  return slam.corrected(stamps, poses);
}

geometry::Twist drift() {
  geometry::Twist twist;
  twist << 0, 0.0005, 0.002, 0.012, 0.004, 0.004;
  return twist;
}

/// The same street twice, the second time a little beside the first.
class TwiceThroughAStreet : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    drive_ = new MadeDrive(drift());
    drive_->pass(4.4, simulation::Drive{});
    simulation::Drive beside;
    beside.amplitude_m = 1.5;
    drive_->pass(4.4, beside);
  }
  static void TearDownTestSuite() { delete drive_; }
  static const MadeDrive& drive() { return *drive_; }

 private:
  static inline MadeDrive* drive_ = nullptr;
};

TEST_F(TwiceThroughAStreet, LoopsUndoTheDrift) {
  const Slam slam = run(drive(), options());
  EXPECT_GE(slam.accepted_loops(), 15U);
  const auto poses = corrected(slam, drive());
  const MadeFrame& first = drive().frames().front();
  double worst_before = 0;
  double worst_after = 0;
  // Where the same place was passed before: errors inside one pass are odometry's in both.
  for (std::size_t k = 22; k < poses.size(); ++k) {
    const MadeFrame& made = drive().frames()[k];
    const geometry::Pose3 truth = first.T_truth.inverse() * made.T_truth;
    const geometry::Pose3 pass_before =
        first.frame.T_map_lidar.inverse() * drive().frames()[k - 22].frame.T_map_lidar;
    const geometry::Pose3 truth_before = first.T_truth.inverse() * drive().frames()[k - 22].T_truth;
    const geometry::Pose3 between = truth_before.inverse() * truth;
    worst_before = std::max(
        worst_before, geometry::log_se3((pass_before * between).inverse() * made.frame.T_map_lidar)
                          .tail<3>()
                          .norm());
    worst_after = std::max(
        worst_after,
        geometry::log_se3((poses[k - 22] * between).inverse() * poses[k]).tail<3>().norm());
  }
  EXPECT_GT(worst_before, 0.3);
  EXPECT_LT(worst_after, 0.05);
}

TEST_F(TwiceThroughAStreet, ASpilledMapGivesTheSameBits) {
  SlamOptions small = options();
  small.memory_mb = 0.5;
  const Slam in_memory = run(drive(), options());
  const Slam spilled = run(drive(), small);
  EXPECT_GT(spilled.keyframes().spilled(), 10U);
  const auto a = corrected(in_memory, drive());
  const auto b = corrected(spilled, drive());
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].matrix(), b[k].matrix());
}

TEST(Slam, WithoutLoopsOdometryStays) {
  MadeDrive drive(drift());
  drive.pass(2, simulation::Drive{});
  const Slam slam = run(drive, options());
  EXPECT_FALSE(slam.is_corrected());
  EXPECT_TRUE(slam.loops().empty());
  const auto poses = corrected(slam, drive);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    EXPECT_EQ(poses[k].matrix(), drive.frames()[k].frame.T_map_lidar.matrix());
  }
}

/// Odometry that nods a little more at every frame, and gravity that tells.
TEST(Slam, GravityUndoesTheTiltOfOdometry) {
  geometry::Twist nod = geometry::Twist::Zero();
  nod[1] = 0.001;
  MadeDrive drive(nod);
  drive.pass(4, simulation::Drive{});
  const auto up_lidar = [](const MadeFrame& made) {
    return Eigen::Vector3d(made.T_truth.rotation.transpose() * Eigen::Vector3d::UnitZ());
  };
  Slam slam(options(), drive.profile());
  for (const MadeFrame& made : drive.frames()) {
    if (!slam.wants(made.frame)) continue;
    slam.add(made.frame, made.scan, testing::points_of(made, drive.profile()), true);
    slam.add_gravity(up_lidar(made), 0.001);
  }
  slam.finish();
  ASSERT_TRUE(slam.is_corrected());
  const Eigen::Vector3d up_map = up_lidar(drive.frames().front());
  const MadeFrame& last = drive.frames().back();
  const auto tilt = [&](const geometry::Pose3& T_map_lidar) {
    return std::acos(std::min(1.0, up_lidar(last).dot(T_map_lidar.rotation.transpose() * up_map)));
  };
  EXPECT_GT(tilt(last.frame.T_map_lidar), 0.015);
  EXPECT_LT(tilt(corrected(slam, drive).back()), 0.001);
}

/// Half an hour without registration; then the street from its beginning, by odometry somewhere
/// else. What odometry may have lost is kilometres and many turns, which no search can cover.
TEST(Slam, AfterTrackingWasLostAPlaceIsSearchedWhereItLooksAlike) {
  MadeDrive drive(geometry::Twist::Zero());
  drive.pass(4.4, simulation::Drive{});
  const std::size_t before = drive.frames().size();
  simulation::Drive beside;
  beside.amplitude_m = 1;
  drive.pass(1, beside);
  Slam slam(options(), drive.profile());
  std::vector<std::size_t> frame_of;
  const auto follow = [&](std::size_t first, std::size_t last, const geometry::Pose3& elsewhere) {
    for (std::size_t k = first; k < last; ++k) {
      const MadeFrame& made = drive.frames()[k];
      lidar::Frame frame = made.frame;
      frame.T_map_lidar = elsewhere * frame.T_map_lidar;
      if (!slam.wants(frame)) continue;
      slam.add(frame, made.scan, testing::points_of(made, drive.profile()), true);
      frame_of.push_back(k);
    }
  };
  follow(0, before, {});
  lidar::Frame lost = drive.frames()[before - 1].frame;
  lost.health = {};
  for (int k = 0; k < 18'000; ++k) ASSERT_FALSE(slam.wants(lost));
  follow(before, drive.frames().size(), {geometry::exp_so3({0, 0, 0.4}), {3000, 500, 20}});
  slam.finish();

  std::size_t right = 0;
  for (const Loop& loop : slam.loops()) {
    if (loop.prediction_sigma_m < 1000) continue;
    const geometry::Pose3 truth = drive.frames()[frame_of[loop.candidate]].T_truth.inverse() *
                                  drive.frames()[frame_of[loop.keyframe]].T_truth;
    const geometry::Twist off = geometry::log_se3(truth.inverse() * loop.T_candidate_keyframe);
    right += loop.is_accepted() && off.tail<3>().norm() < 0.1 ? 1 : 0;
  }
  EXPECT_GE(right, 2U);
}

/// Two streets that look exactly the same, 200 m apart by odometry.
TEST(Slam, APlaceThatOnlyLooksTheSameIsTurnedAway) {
  MadeDrive drive(geometry::Twist::Zero());
  drive.pass(4, simulation::Drive{});
  Slam slam(options(), drive.profile());
  for (const double shift_m : {0.0, 200.0}) {
    for (const MadeFrame& made : drive.frames()) {
      lidar::Frame frame = made.frame;
      frame.T_map_lidar.translation.y() += shift_m;
      frame.stamp = geometry::shifted(frame.stamp, shift_m);
      if (!slam.wants(frame)) continue;
      slam.add(frame, made.scan, testing::points_of(made, drive.profile()), true);
    }
  }
  slam.finish();
  EXPECT_EQ(slam.accepted_loops(), 0U);
  std::size_t turned_away = 0;
  for (const Loop& loop : slam.loops()) {
    if (loop.verdict == LoopVerdict::kOdometry) ++turned_away;
  }
  EXPECT_GE(turned_away, 5U);
}

}  // namespace
}  // namespace traverse::slam
