// What all odometries promise is tested in tests/lidar/odometry_contract_test.cpp.
#include "traverse/voxel_map/voxel_map_odometry.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "traverse/optimization/jacobian_audit.hpp"
#include "traverse/voxel_map/row_factor_kinds.hpp"

#include "lidar/odometry_trial.hpp"
#include "lidar/simulated_drive.hpp"

namespace traverse::voxel_map {
namespace {

using testing::SimulatedDrive;
using testing::worst_position_error;

std::vector<lidar::Frame> run(const SimulatedDrive& drive, const VoxelMapOdometryOptions& options) {
  VoxelMapOdometry odometry(options, drive.scanner.profile, false);
  return testing::frames_of(odometry, drive);
}

/// The defaults, with few hypotheses of the initial speed: the search has its own test.
VoxelMapOdometryOptions quick_start() {
  VoxelMapOdometryOptions options;
  options.start.slowest_mps = 8;
  options.start.fastest_mps = 16;
  return options;
}

class VoxelStreet : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { street_ = new SimulatedDrive(simulation::street(40, 1), 16, 12); }
  static void TearDownTestSuite() { delete street_; }
  static const SimulatedDrive& street() { return *street_; }

 private:
  static inline SimulatedDrive* street_ = nullptr;
};

TEST_F(VoxelStreet, ItsFactorsAreKinds) {
  const VoxelMapOdometry odometry({}, street().scanner.profile, false);
  const auto kinds = optimization::selected(row_factor_kinds(), odometry.factors());
  ASSERT_EQ(kinds.size(), 2U);
  EXPECT_EQ(kinds[0].name, "voxel plane row");
  EXPECT_EQ(kinds[1].name, "voxel line rows");
}

TEST_F(VoxelStreet, FindsEverySpeedAtTheStart) {
  for (const double speed : {0.0, 7.0, 21.0, 33.0}) {
    const SimulatedDrive drive(simulation::street(20, 5), 4, speed);
    const auto frames = run(drive, {});
    EXPECT_LT(worst_position_error(frames, drive), 0.1) << speed;
  }
}

TEST_F(VoxelStreet, StartingFromRestLagsBehind) {
  VoxelMapOdometryOptions options;
  options.start.scans = 0;
  EXPECT_GT(worst_position_error(run(street(), options), street()), 0.3);
}

TEST_F(VoxelStreet, RingsBeyondTheProfileAreCountedNotUsed) {
  SimulatedDrive drive = street();
  drive.scanner.profile.rings = 48;
  const auto frames = run(drive, quick_start());
  EXPECT_GT(frames[5].dropped.beyond_profile_rings, 5000U);
  EXPECT_LT(worst_position_error(frames, drive), 0.1);
}

TEST_F(VoxelStreet, EqualStampsCountAsOneSweep) {
  SimulatedDrive drive = street();
  for (auto& scan : drive.scans) scan.stamp = drive.scans.front().stamp;
  EXPECT_LT(worst_position_error(run(drive, quick_start()), drive), 0.06);
}

TEST(VoxelOdometry, SixteenRingsAreEnough) {
  SimulatedDrive drive(simulation::street(60, 2), 0, 12);
  drive.scanner.profile.rings = 16;
  drive.scanner.profile.max_range_m = 100;
  drive.scanner.profile.elevations_deg.clear();
  for (int ring = 0; ring < 16; ++ring) {
    drive.scanner.profile.elevations_deg.push_back(2 * ring - 15);
  }
  drive.scanner.azimuth_steps = 1800;
  const simulation::AnalyticScene scene = simulation::street(60, 2);
  for (int i = 0; i < 25; ++i) {
    drive.scans.push_back(drive.scanner.scan(scene, drive.drive, 0.1 * i));
    drive.truth.push_back(drive.drive.pose(0).inverse() * drive.drive.pose(0.1 * i));
  }
  EXPECT_LT(worst_position_error(run(drive, quick_start()), drive), 0.1);  // over 29 m
}

TEST(VoxelOdometry, ATunnelIsReportedDegenerateAndTheEstimateDoesNotJump) {
  simulation::Drive straight;
  straight.speed_mps = 8;
  straight.amplitude_m = 0;
  const SimulatedDrive drive(simulation::tunnel(100), 16, straight);
  const auto frames = run(drive, quick_start());
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const lidar::Observability& seen = frames[i].health.observability;
    EXPECT_EQ(seen.degenerate, 1) << i;
    EXPECT_GT(std::abs(seen.directions(3, 0)), 0.99) << "along the tunnel";
    const Eigen::Vector3d step =
        frames[i].T_map_lidar.translation - frames[i - 1].T_map_lidar.translation;
    EXPECT_LT(step.norm(), 0.1) << i;  // it started from rest and nothing tells otherwise
  }
}

TEST(VoxelOdometry, MemoryStaysFlatOnALoop) {
  // The same stretch again and again: cells are found again, not added.
  const SimulatedDrive drive(simulation::street(20, 3), 6, 0);
  VoxelMapOdometry odometry({}, drive.scanner.profile, false);
  std::size_t after_one = 0;
  geometry::Stamp stamp;
  for (int round = 0; round < 4; ++round) {
    for (sensors::LidarScan scan : drive.scans) {
      stamp = geometry::shifted(stamp, 0.1);
      scan.stamp = stamp;
      odometry.process(scan);
    }
    if (round == 0) after_one = odometry.map().bytes();
  }
  EXPECT_LT(odometry.map().bytes(), 1.5 * static_cast<double>(after_one));
}

}  // namespace
}  // namespace traverse::voxel_map
