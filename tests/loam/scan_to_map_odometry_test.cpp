// What all odometries promise is tested in tests/lidar/odometry_contract_test.cpp.
#include "traverse/loam/scan_to_map_odometry.hpp"

#include <gtest/gtest.h>

#include "lidar/odometry_trial.hpp"
#include "lidar/simulated_drive.hpp"

namespace traverse::loam {
namespace {

using testing::SimulatedDrive;

/// The defaults, with few hypotheses of the initial speed: the search has its own test.
ScanToMapOdometryOptions quick_start() {
  ScanToMapOdometryOptions options;
  options.start.slowest_mps = 8;
  options.start.fastest_mps = 16;
  return options;
}

TEST(ScanToMapOdometry, EqualStampsLeaveTheSpeed) {
  const SimulatedDrive street(simulation::street(60, 1), 14, 12);
  for (const std::size_t at : {1U, 9U}) {  // within the start, and after it
    SimulatedDrive drive = street;
    drive.scans.insert(drive.scans.begin() + static_cast<std::ptrdiff_t>(at), drive.scans[at]);
    ScanToMapOdometry odometry(quick_start(), drive.scanner.profile, false);
    const auto frames = testing::frames_of(odometry, drive);
    ASSERT_EQ(frames.size(), drive.scans.size());
    EXPECT_EQ(frames[at + 1].velocity, frames[at].velocity);
    drive.truth.insert(drive.truth.begin() + static_cast<std::ptrdiff_t>(at), drive.truth[at]);
    EXPECT_LT(testing::worst_position_error(frames, drive), 0.1);
  }
}

TEST(ScanToMapOdometry, StartingFromRestLagsBehind) {
  const SimulatedDrive drive(simulation::street(60, 1), 24, 12);
  ScanToMapOdometryOptions options = quick_start();
  options.start.scans = 0;
  ScanToMapOdometry odometry(options, drive.scanner.profile, false);
  EXPECT_GT(testing::worst_position_error(testing::frames_of(odometry, drive), drive), 0.3);
}

TEST(ScanToMapOdometry, TheFirstFramesTakeMoreSteps) {
  const SimulatedDrive drive(simulation::street(60, 1), 14, 12);
  ScanToMapOdometry odometry(quick_start(), drive.scanner.profile, false);
  const auto frames = testing::frames_of(odometry, drive);
  EXPECT_EQ(frames[0].health.steps, 0);
  EXPECT_EQ(frames[1].health.steps, 12);
  EXPECT_EQ(frames[5].health.steps, 8);
  EXPECT_EQ(frames[13].health.steps, 2);
}

}  // namespace
}  // namespace traverse::loam
