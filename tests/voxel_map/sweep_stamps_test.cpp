#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "traverse/sensors/sweep_timing.hpp"
#include "traverse/simulation/analytic_scene.hpp"
#include "traverse/voxel_map/voxel_map_odometry.hpp"

#include "lidar/odometry_trial.hpp"
#include "lidar/simulated_drive.hpp"

namespace traverse::voxel_map {
namespace {

using testing::SimulatedDrive;

geometry::Stamp moved(const geometry::Stamp& stamp, double seconds) {
  return {stamp.nanoseconds + std::llround(seconds * 1e9)};
}

/// The same sweeps with the times of their points, stamped `shift_s` after their middle.
SimulatedDrive stamped(const SimulatedDrive& drive, double shift_s) {
  SimulatedDrive result = drive;
  for (sensors::LidarScan& scan : result.scans) {
    scan.time = sensors::point_times(scan, drive.scanner.profile);
    for (float& time : scan.time) time -= static_cast<float>(shift_s);
    scan.stamp = moved(scan.stamp, shift_s);
  }
  result.scanner.profile.time_source = sensors::TimeSource::kData;
  for (std::size_t i = 0; i < result.truth.size(); ++i) {
    const double t = 0.1 * static_cast<double>(i) + shift_s;
    result.truth[i] = drive.drive.pose(shift_s).inverse() * drive.drive.pose(t);
  }
  return result;
}

std::vector<lidar::Frame> frames_of(const SimulatedDrive& drive) {
  VoxelMapOdometryOptions options;
  options.start.slowest_mps = 8;
  options.start.fastest_mps = 16;
  VoxelMapOdometry odometry(options, drive.scanner.profile, false);
  return testing::frames_of(odometry, drive);
}

class SweepStamps : public ::testing::TestWithParam<double> {};

TEST_P(SweepStamps, WhereverTheyAreTheDriveIsTheSame) {
  const SimulatedDrive middle(simulation::street(40, 1), 20, 12);
  const SimulatedDrive drive = stamped(middle, GetParam());
  const auto frames = frames_of(drive);
  ASSERT_EQ(frames.size(), drive.scans.size());
  EXPECT_LT(testing::worst_position_error(frames, drive), 0.08);  // over 24 m
}

// An error that changes its sign from frame to frame shows in the second differences.
TEST_P(SweepStamps, ASwervingDriveDoesNotZigzag) {
  const SimulatedDrive middle(simulation::street(40, 1), 20, testing::swerving());
  const SimulatedDrive drive = stamped(middle, GetParam());
  const auto frames = frames_of(drive);
  for (std::size_t i = 3; i + 1 < frames.size(); ++i) {
    const auto error = [&](std::size_t k) {
      return Eigen::Vector3d(frames[k].T_map_lidar.translation - drive.truth[k].translation);
    };
    EXPECT_LT((error(i + 1) - 2 * error(i) + error(i - 1)).norm(), 0.08) << "frame " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(StartMiddleEnd, SweepStamps, ::testing::Values(-0.05, 0, 0.03, 0.05));

TEST(SweepStampsOfArrival, DoNotShakeTheDrive) {
  const SimulatedDrive steady(simulation::street(40, 1), 25, 12);
  SimulatedDrive drive = stamped(steady, -0.05);
  std::mt19937 generator(7);
  std::normal_distribution<double> late(0, 0.02);
  for (sensors::LidarScan& scan : drive.scans) scan.stamp = moved(scan.stamp, late(generator));
  EXPECT_LT(testing::worst_position_error(frames_of(drive), drive), 0.15);
}

TEST(SweepStampsOfArrival, AScanWithOneTimeForAllItsPointsIsBridged) {
  const SimulatedDrive steady(simulation::street(40, 1), 16, 12);
  SimulatedDrive drive = stamped(steady, -0.05);
  for (float& time : drive.scans[10].time) time = 0;
  EXPECT_LT(testing::worst_position_error(frames_of(drive), drive), 0.1);
}

/// A large hall of which downward beams see the floor, and little of the walls.
TEST(WeaklySeenDirections, AHallWithAFlatFloorDoesNotHoldTheVehicle) {
  simulation::AnalyticScene hall;
  hall.add(simulation::Rectangle{{-40, -30, 0}, {100, 0, 0}, {0, 60, 0}});
  hall.add(simulation::Rectangle{{-40, -30, 0}, {100, 0, 0}, {0, 0, 8}});
  hall.add(simulation::Rectangle{{-40, 30, 0}, {100, 0, 0}, {0, 0, 8}});
  hall.add(simulation::Rectangle{{-40, -30, 0}, {0, 60, 0}, {0, 0, 8}});
  hall.add(simulation::Rectangle{{60, -30, 0}, {0, 60, 0}, {0, 0, 8}});
  for (int k = 0; k < 6; ++k) {
    hall.add_box({-20.0 + 15 * k, k % 2 == 0 ? 9.3 : -11.7, 0}, {1.5, 1.2, 1.8}, 0.3 * k, 0.5);
  }
  for (const double speed : {0.0, 5.0, 12.0}) {
    SimulatedDrive drive(hall, 12, speed);
    VoxelMapOdometry odometry({}, drive.scanner.profile, false);
    const auto frames = testing::frames_of(odometry, drive);
    EXPECT_LT(testing::worst_position_error(frames, drive), 0.1) << speed;
  }
}

}  // namespace
}  // namespace traverse::voxel_map
