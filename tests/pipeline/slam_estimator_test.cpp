#include "slam_estimator.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/loam/scan_to_map_odometry.hpp"

#include "lidar/simulated_drive.hpp"

namespace traverse::pipeline {
namespace {

using ::testing::HasSubstr;

const geometry::Pose3 kT_body_imu{Eigen::Matrix3d::Identity(), {-0.4, 0.2, -0.3}};

/// What an IMU on the vehicle reads, by differences of its exact poses.
sensors::ImuSample imu_sample(const simulation::Drive& drive, double seconds) {
  constexpr double h = 1e-3;
  const auto place = [&](double s) { return (drive.pose(s) * kT_body_imu).translation; };
  const Eigen::Vector3d acceleration =
      (place(seconds + h) - 2 * place(seconds) + place(seconds - h)) / (h * h);
  sensors::ImuSample sample;
  sample.stamp = geometry::Stamp::from_seconds(seconds);
  sample.sensor = "imu";
  sample.specific_force =
      drive.pose(seconds).rotation.transpose() * (acceleration + Eigen::Vector3d(0, 0, 9.81));
  return sample;
}

/// A short drive along a street, seen by a lidar at the body's origin and by an IMU.
class AShortDrive : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    drive_ = new testing::SimulatedDrive(simulation::street(60, 1), 16, 10);
    for (std::size_t k = 0; k < drive_->scans.size(); ++k) {
      drive_->scans[k].stamp = geometry::Stamp::from_seconds(0.1 * static_cast<double>(k));
    }
  }
  static void TearDownTestSuite() { delete drive_; }

  static SlamEstimator estimator(bool with_imu, bool use_gravity, bool with_gnss = false) {
    dataset::RecordingInfo recording;
    recording.path = "made";
    recording.rig.sensors.push_back(
        {"lidar", sensors::SensorKind::kLidar, {}, drive_->scanner.profile});
    if (with_imu) {
      recording.rig.sensors.push_back(
          {"imu", sensors::SensorKind::kImu, kT_body_imu, std::nullopt});
    }
    if (with_gnss) {
      recording.rig.sensors.push_back({"gnss", sensors::SensorKind::kGnss, {}, std::nullopt});
    }
    loam::ScanToMapOdometryOptions odometry;
    odometry.start.scans = 2;
    odometry.start.slowest_mps = odometry.start.fastest_mps = 10;
    const auto make = [&](const sensors::LidarProfile& profile, bool motion_compensated) {
      return std::make_unique<loam::ScanToMapOdometry>(odometry, profile, motion_compensated);
    };
    SlamEstimatorOptions options;
    options.gravity.use = use_gravity;
    options.gravity.finder.window_s = 0.7;
    return {std::make_unique<LidarEstimator>(make, recording), recording, options};
  }

  /// Feeds the samples and scans of frames [first, last).
  static void feed(Estimator& estimator, std::size_t first, std::size_t last,
                   std::vector<PoseFrame>& frames) {
    for (std::size_t k = first; k < last; ++k) {
      for (int i = 0; i < 10; ++i) {
        estimator.process(imu_sample(drive_->drive, 0.1 * static_cast<double>(k) + 0.01 * i - 0.1));
      }
      const auto scan = std::make_shared<const sensors::LidarScan>(drive_->scans[k]);
      for (PoseFrame& frame : estimator.process(scan)) frames.push_back(std::move(frame));
    }
  }
  static geometry::Trajectory corrected(Estimator& estimator, std::vector<PoseFrame> frames) {
    for (PoseFrame& frame : estimator.finish()) frames.push_back(std::move(frame));
    geometry::Trajectory trajectory;
    for (const PoseFrame& frame : frames) trajectory.push_back(frame.stamp, frame.T_map_body);
    return estimator.slam_map()->corrected(trajectory);
  }
  static std::size_t scans() { return drive_->scans.size(); }

  static inline testing::SimulatedDrive* drive_ = nullptr;
};

std::string gravity_decision(const Estimator& estimator) {
  for (const Decision& decision : estimator.decisions()) {
    if (decision.name == "gravity") return decision.value;
  }
  return "";
}

bool are_same(const geometry::Trajectory& a, const geometry::Trajectory& b) {
  return std::equal(a.poses().begin(), a.poses().end(), b.poses().begin(), b.poses().end(),
                    [](const auto& p, const auto& q) { return p.matrix() == q.matrix(); });
}

TEST_F(AShortDrive, GravityIsTakenFromTheImu) {
  SlamEstimator slam = estimator(true, true);
  std::vector<PoseFrame> frames;
  feed(slam, 0, scans(), frames);
  const geometry::Trajectory trajectory = corrected(slam, frames);
  const pose_graph::PoseGraph& graph = slam.slam_map()->slam().graph();
  EXPECT_EQ(graph.levels().size(), 2U);
  EXPECT_THAT(gravity_decision(slam), HasSubstr("2 directions of up by imu (sigma"));
  const Eigen::Vector3d up = drive_->drive.pose(0).rotation.transpose() * Eigen::Vector3d::UnitZ();
  const double sigma = graph.levels().front().sigma_rad;
  EXPECT_LT(sigma, 0.02);
  EXPECT_LT(std::acos(graph.up_map()->dot(up)), 3 * sigma);
  EXPECT_TRUE(slam.slam_map()->slam().is_corrected());
}

TEST_F(AShortDrive, WithoutAnImuNothingChanges) {
  SlamEstimator without = estimator(false, true);
  SlamEstimator unused = estimator(true, false);
  std::vector<PoseFrame> frames, frames_unused;
  feed(without, 0, scans(), frames);
  feed(unused, 0, scans(), frames_unused);
  geometry::Trajectory by_odometry;
  for (const PoseFrame& frame : frames) by_odometry.push_back(frame.stamp, frame.T_map_body);
  EXPECT_TRUE(are_same(corrected(without, frames), by_odometry));
  EXPECT_TRUE(are_same(corrected(unused, frames_unused), by_odometry));
  EXPECT_EQ(gravity_decision(without), "");
  EXPECT_EQ(gravity_decision(unused), "");
}

/// A driver that sends a scan twice: between two frames of one stamp nothing can be interpolated.
TEST_F(AShortDrive, AFixBetweenFramesOfOneStampIsPlacedAtThem) {
  SlamEstimator slam = estimator(false, false, true);
  std::vector<PoseFrame> frames;
  feed(slam, 0, 4, frames);
  sensors::GnssFix fix;
  fix.sensor = "gnss";
  fix.stamp = drive_->scans[3].stamp;
  fix.latitude_deg = 52;
  fix.longitude_deg = 13;
  fix.altitude_m = 40;
  slam.process(fix);
  feed(slam, 3, scans(), frames);
  fix.latitude_deg = std::numeric_limits<double>::quiet_NaN();
  slam.process(fix);
  slam.finish();
  const slam::Slam& done = slam.slam_map()->slam();
  ASSERT_EQ(done.graph().fixes().size(), 1U);
  EXPECT_TRUE(done.graph().fixes().front().antenna_body.allFinite());
  EXPECT_LT(done.graph().fixes().front().antenna_body.norm(), 4);
  EXPECT_EQ(done.failure(), "");
}

TEST_F(AShortDrive, ACopyGoesOnAlike) {
  SlamEstimator slam = estimator(true, true);
  std::vector<PoseFrame> frames;
  feed(slam, 0, 8, frames);
  const auto copy = slam.clone();
  std::vector<PoseFrame> frames_of_copy = frames;
  feed(slam, 8, scans(), frames);
  feed(*copy, 8, scans(), frames_of_copy);
  EXPECT_TRUE(are_same(corrected(slam, frames), corrected(*copy, frames_of_copy)));
  EXPECT_EQ(gravity_decision(slam), gravity_decision(*copy));
}

}  // namespace
}  // namespace traverse::pipeline
