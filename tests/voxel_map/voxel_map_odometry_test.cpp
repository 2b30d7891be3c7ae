#include "traverse/voxel_map/voxel_map_odometry.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "traverse/optimization/jacobian_audit.hpp"
#include "traverse/voxel_map/row_factor_kinds.hpp"

#include "lidar/odometry_trial.hpp"
#include "lidar/shown_matches.hpp"
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

TEST_F(VoxelStreet, FollowsADriveThatStartsAtSpeed) {
  const auto frames = run(street(), quick_start());
  ASSERT_EQ(frames.size(), street().scans.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].index, i);
    EXPECT_EQ(frames[i].stamp, street().scans[i].stamp);
    EXPECT_EQ(frames[i].health.registered, i > 0);
    EXPECT_EQ(frames[i].health.observability.degenerate, 0);
    EXPECT_EQ(frames[i].points, street().scans[i].size());
  }
  EXPECT_LT(worst_position_error(frames, street()), 0.06);  // over 18 m, range noise 2 cm
}

TEST_F(VoxelStreet, ShowsItsMatchesAndItsMap) {
  VoxelMapOdometry odometry(quick_start(), street().scanner.profile, false);
  EXPECT_TRUE(odometry.matches().empty());
  EXPECT_TRUE(odometry.local_map().empty());
  std::vector<lidar::Frame> frames;
  for (const auto& scan : street().scans) frames = odometry.process(scan);
  testing::expect_consistent_view(odometry, frames.back(), 1.5);
}

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

TEST_F(VoxelStreet, SameBytesOnRepeatAndForAnyNumberOfThreads) {
  const auto one = run(street(), quick_start());
  for (const int threads : {1, 2, 4}) {
    VoxelMapOdometryOptions options = quick_start();
    options.threads = threads;
    const auto many = run(street(), options);
    ASSERT_EQ(one.size(), many.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      const Eigen::Matrix4d a = one[i].T_map_lidar.matrix();
      const Eigen::Matrix4d b = many[i].T_map_lidar.matrix();
      EXPECT_EQ(std::memcmp(a.data(), b.data(), sizeof(double) * 16), 0)
          << "frame " << i << ", " << threads << " threads";
      EXPECT_EQ(one[i].health.residual_rms_m, many[i].health.residual_rms_m);
    }
  }
}

TEST_F(VoxelStreet, ADroppedScanDoesNotBreakThePrediction) {
  SimulatedDrive drive = street();
  drive.scans.erase(drive.scans.begin() + 8, drive.scans.begin() + 11);  // a gap of 0.4 s
  drive.truth.erase(drive.truth.begin() + 8, drive.truth.begin() + 11);
  EXPECT_LT(worst_position_error(run(drive, quick_start()), drive), 0.1);
}

TEST_F(VoxelStreet, AScanOfNoOrThreePointsKeepsThePredictionAndSaysSo) {
  for (const std::size_t points : {0U, 3U}) {
    SimulatedDrive drive = street();
    sensors::LidarScan& poor = drive.scans[10];
    for (auto* values : {&poor.x, &poor.y, &poor.z, &poor.intensity, &poor.time}) {
      values->resize(points);
    }
    poor.ring.resize(points);
    const auto frames = run(drive, quick_start());
    EXPECT_FALSE(frames[10].health.registered);
    EXPECT_EQ(frames[10].health.observability.degenerate, 6);
    EXPECT_TRUE(frames[11].health.registered);
    EXPECT_LT(worst_position_error(frames, drive), 0.15);
  }
}

TEST_F(VoxelStreet, AFirstScanWithoutPointsIsNoMap) {
  SimulatedDrive drive = street();
  const geometry::Stamp stamp = drive.scans[0].stamp;
  drive.scans[0] = {};
  drive.scans[0].stamp = stamp;
  const auto frames = run(drive, quick_start());
  ASSERT_EQ(frames.size(), drive.scans.size());
  EXPECT_FALSE(frames[1].health.registered);
  EXPECT_TRUE(frames[3].health.registered);
}

TEST_F(VoxelStreet, NotANumberPointsAreCountedNotUsed) {
  SimulatedDrive drive = street();
  for (auto& scan : drive.scans) {
    for (std::size_t i = 0; i < scan.size(); i += 50) {
      scan.x[i] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  const auto frames = run(drive, quick_start());
  EXPECT_GT(frames[5].dropped.not_finite, 500U);
  EXPECT_LT(worst_position_error(frames, drive), 0.06);
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

TEST_F(VoxelStreet, ACloudWithoutRingsIsFollowedToo) {
  SimulatedDrive drive = street();
  for (auto& scan : drive.scans) scan.ring.clear();
  EXPECT_LT(worst_position_error(run(drive, quick_start()), drive), 0.1);
}

TEST_F(VoxelStreet, ARecordingShorterThanTheStartIsNotLost) {
  for (const std::size_t count : {1U, 2U, 3U}) {
    SimulatedDrive drive = street();
    drive.scans.resize(count);
    const auto frames = run(drive, quick_start());
    ASSERT_EQ(frames.size(), count);
    EXPECT_LT(worst_position_error(frames, drive), 0.1);
  }
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

TEST(VoxelOdometry, WithoutDeskewASwervingDriveIsWorse) {
  simulation::Drive swerving;
  swerving.speed_mps = 12;
  swerving.amplitude_m = 3;
  swerving.wavelength_m = 40;  // up to 0.9 rad/s
  const SimulatedDrive drive(simulation::street(40, 1), 16, swerving);
  VoxelMapOdometryOptions options = quick_start();
  const double with_deskew = worst_position_error(run(drive, options), drive);
  options.deskew = false;
  EXPECT_GT(worst_position_error(run(drive, options), drive), 2 * with_deskew);
  EXPECT_LT(with_deskew, 0.1);
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

TEST(VoxelOdometry, SaysWhyItDoesNotDeskew) {
  sensors::LidarProfile profile;
  EXPECT_EQ(VoxelMapOdometry({}, profile, false).deskew_note(), "on");
  EXPECT_EQ(VoxelMapOdometry({}, profile, true).deskew_note(),
            "off: the recording is motion-compensated");
  profile.time_source = sensors::TimeSource::kNone;
  EXPECT_EQ(VoxelMapOdometry({}, profile, false).deskew_note(), "off: point times are unknown");
}

}  // namespace
}  // namespace traverse::voxel_map
