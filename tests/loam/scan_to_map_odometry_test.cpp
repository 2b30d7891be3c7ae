#include "traverse/loam/scan_to_map_odometry.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "traverse/sensors/rings.hpp"

#include "lidar/odometry_trial.hpp"
#include "lidar/shown_matches.hpp"
#include "lidar/simulated_drive.hpp"

namespace traverse::loam {
namespace {

using testing::SimulatedDrive;
using testing::worst_position_error;

std::vector<lidar::Frame> run(const SimulatedDrive& drive,
                              const ScanToMapOdometryOptions& options) {
  ScanToMapOdometry odometry(options, drive.scanner.profile, false);
  return testing::frames_of(odometry, drive);
}

/// The defaults, with few hypotheses of the initial speed: the search has its own test.
ScanToMapOdometryOptions quick_start() {
  ScanToMapOdometryOptions options;
  options.start.slowest_mps = 8;
  options.start.fastest_mps = 16;
  return options;
}

class StreetOdometry : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { street_ = new SimulatedDrive(simulation::street(60, 1), 24, 12); }
  static void TearDownTestSuite() { delete street_; }
  static const SimulatedDrive& street() { return *street_; }

 private:
  static inline SimulatedDrive* street_ = nullptr;
};

TEST_F(StreetOdometry, FollowsADriveThatStartsAtSpeed) {
  const auto frames = run(street(), quick_start());
  ASSERT_EQ(frames.size(), street().scans.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].index, i);
    EXPECT_EQ(frames[i].stamp, street().scans[i].stamp);
    EXPECT_EQ(frames[i].health.registered, i > 0);
    EXPECT_EQ(frames[i].health.observability.degenerate, 0);
  }
  EXPECT_LT(worst_position_error(frames, street()), 0.1);  // over 28 m, range noise 2 cm
}

TEST_F(StreetOdometry, ShowsItsMatchesAndItsMap) {
  ScanToMapOdometry odometry(quick_start(), street().scanner.profile, false);
  EXPECT_TRUE(odometry.matches().empty());
  std::vector<lidar::Frame> frames;
  for (const auto& scan : street().scans) frames = odometry.process(scan);
  testing::expect_consistent_view(odometry, frames.back(), 1);
}

TEST_F(StreetOdometry, StartingFromRestLagsBehind) {
  ScanToMapOdometryOptions options = quick_start();
  options.start.scans = 0;
  EXPECT_GT(worst_position_error(run(street(), options), street()), 0.3);
}

TEST_F(StreetOdometry, SameBitsOnRepeatAndForAnyNumberOfThreads) {
  const auto one = run(street(), quick_start());
  for (const int threads : {1, 2, 4}) {
    ScanToMapOdometryOptions options = quick_start();
    options.threads = threads;
    const auto many = run(street(), options);
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(one[i].T_map_lidar.matrix(), many[i].T_map_lidar.matrix()) << threads;
    }
  }
}

TEST_F(StreetOdometry, ADroppedScanDoesNotBreakThePrediction) {
  SimulatedDrive drive = street();
  drive.scans.erase(drive.scans.begin() + 12, drive.scans.begin() + 15);  // a gap of 0.4 s
  drive.truth.erase(drive.truth.begin() + 12, drive.truth.begin() + 15);
  EXPECT_LT(worst_position_error(run(drive, quick_start()), drive), 0.1);
}

TEST_F(StreetOdometry, AScanWithoutFeaturesKeepsThePredictionAndSaysSo) {
  SimulatedDrive drive = street();
  const geometry::Stamp stamp = drive.scans[20].stamp;
  drive.scans[20] = sensors::LidarScan{};
  drive.scans[20].stamp = stamp;
  const auto frames = run(drive, quick_start());
  EXPECT_FALSE(frames[20].health.registered);
  EXPECT_TRUE(frames[21].health.registered);
  EXPECT_LT(worst_position_error(frames, drive), 0.15);
}

TEST_F(StreetOdometry, EqualStampsGiveAFrameAndLeaveTheSpeed) {
  for (const std::size_t at : {1U, 9U}) {  // within the start, and after it
    SimulatedDrive drive = street();
    drive.scans.resize(14);
    drive.scans.insert(drive.scans.begin() + static_cast<std::ptrdiff_t>(at), drive.scans[at]);
    drive.truth.insert(drive.truth.begin() + static_cast<std::ptrdiff_t>(at), drive.truth[at]);
    const auto frames = run(drive, quick_start());
    ASSERT_EQ(frames.size(), drive.scans.size());
    EXPECT_EQ(frames[at + 1].velocity, frames[at].velocity);
    EXPECT_LT(worst_position_error(frames, drive), 0.1);
  }
}

TEST_F(StreetOdometry, NotANumberPointsAreCountedNotUsed) {
  SimulatedDrive drive = street();
  for (auto& scan : drive.scans) {
    for (std::size_t i = 0; i < scan.size(); i += 50) {
      scan.x[i] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  const auto frames = run(drive, quick_start());
  EXPECT_GT(frames[5].dropped.not_finite, 500U);
  EXPECT_LT(worst_position_error(frames, drive), 0.1);
}

TEST_F(StreetOdometry, ARecordingShorterThanTheStartIsNotLost) {
  for (const std::size_t count : {1U, 2U, 3U}) {
    SimulatedDrive drive = street();
    drive.scans.resize(count);
    const auto frames = run(drive, quick_start());
    ASSERT_EQ(frames.size(), count);
    EXPECT_LT(worst_position_error(frames, drive), 0.1);
  }
}

TEST(Odometry, WithoutDeskewASwervingDriveIsWorse) {
  const SimulatedDrive drive(simulation::street(60, 1), 24, testing::swerving());
  ScanToMapOdometryOptions options = quick_start();
  const double with_deskew = worst_position_error(run(drive, options), drive);
  options.deskew = false;
  EXPECT_GT(worst_position_error(run(drive, options), drive), 2 * with_deskew);
  EXPECT_LT(with_deskew, 0.15);
}

TEST(Odometry, ATunnelIsReportedDegenerateAndTheEstimateDoesNotJump) {
  const SimulatedDrive drive(simulation::tunnel(100), 20, 8);
  const auto frames = run(drive, quick_start());
  for (std::size_t i = 5; i < frames.size(); ++i) {
    EXPECT_GE(frames[i].health.observability.degenerate, 1) << i;
    const double step =
        (frames[i].T_map_lidar.translation - frames[i - 1].T_map_lidar.translation).norm();
    EXPECT_LT(step, 0.3) << i;
  }
}

TEST(Odometry, SaysWhyItDoesNotDeskew) {
  sensors::LidarProfile profile;
  EXPECT_EQ(ScanToMapOdometry({}, profile, false).deskew_note(), "on");
  EXPECT_EQ(ScanToMapOdometry({}, profile, true).deskew_note(),
            "off: the recording is motion-compensated");
  profile.time_source = sensors::TimeSource::kNone;
  EXPECT_EQ(ScanToMapOdometry({}, profile, false).deskew_note(), "off: point times are unknown");
}

TEST(Odometry, AScanWithoutRingsIsAnError) {
  sensors::LidarScan scan;
  scan.x = scan.y = scan.z = {1, 2, 3};
  ScanToMapOdometry odometry({}, sensors::LidarProfile{}, false);
  EXPECT_THROW(odometry.process(scan), sensors::NoRings);
}

}  // namespace
}  // namespace traverse::loam
