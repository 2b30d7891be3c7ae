#include "lidar_estimator.hpp"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

#include "traverse/geometry/se3.hpp"
#include "traverse/loam/scan_to_map_odometry.hpp"
#include "traverse/voxel_map/voxel_map_odometry.hpp"

#include "geometry/random_motion.hpp"
#include "lidar/simulated_drive.hpp"

namespace traverse::pipeline {
namespace {

dataset::RecordingInfo recording_with(const sensors::LidarProfile& profile,
                                      const geometry::Pose3& T_body_lidar) {
  dataset::RecordingInfo info;
  info.path = "made";
  sensors::MountedSensor lidar;
  lidar.label = "lidar";
  lidar.T_body_sensor = T_body_lidar;
  lidar.lidar = profile;
  info.rig.sensors.push_back(lidar);
  return info;
}

loam::ScanToMapOdometryOptions quick_options() {
  loam::ScanToMapOdometryOptions options;
  options.start.scans = 2;
  options.start.slowest_mps = options.start.fastest_mps = 10;
  return options;
}

LidarEstimator make_estimator(const loam::ScanToMapOdometryOptions& options,
                              const dataset::RecordingInfo& recording) {
  const auto make = [&](const sensors::LidarProfile& profile, bool motion_compensated) {
    return std::make_unique<loam::ScanToMapOdometry>(options, profile, motion_compensated);
  };
  return LidarEstimator(make, recording);
}

std::vector<PoseFrame> run(LidarEstimator& estimator, const testing::SimulatedDrive& drive) {
  std::vector<PoseFrame> frames;
  for (const auto& scan : drive.scans) {
    for (auto& frame : estimator.process(std::make_shared<const sensors::LidarScan>(scan))) {
      frames.push_back(std::move(frame));
    }
  }
  return frames;
}

TEST(LidarEstimator, CovariancesAreOfTheBodysPoseWithTheLeverOfTheLidar) {
  const testing::SimulatedDrive drive(simulation::street(60, 1), 5, 10);
  testing::RandomMotion random(1);
  const geometry::Pose3 T_body_lidar = random.pose(1, 2);
  voxel_map::VoxelMapOdometryOptions options;
  options.start.scans = 2;
  options.start.slowest_mps = options.start.fastest_mps = 10;
  options.covariance = true;
  const auto make = [&](const sensors::LidarProfile& profile, bool motion_compensated) {
    return std::make_unique<voxel_map::VoxelMapOdometry>(options, profile, motion_compensated);
  };
  LidarEstimator estimator(make, recording_with(drive.scanner.profile, T_body_lidar));
  const auto frames = run(estimator, drive);
  ASSERT_EQ(frames.size(), 5U);
  voxel_map::VoxelMapOdometry odometry(options, drive.scanner.profile, false);
  std::vector<lidar::Frame> of_lidar;
  for (const auto& scan : drive.scans) {
    for (lidar::Frame& frame : odometry.process(scan)) of_lidar.push_back(std::move(frame));
  }
  const geometry::Matrix6 to_body = geometry::adjoint(T_body_lidar);
  const geometry::Matrix6 expected =
      to_body * of_lidar.back().covariance.value() * to_body.transpose();
  const auto& columns = estimator.columns();
  const auto first = std::find(columns.begin(), columns.end(), "covariance_rx_rx");
  ASSERT_NE(first, columns.end());
  auto at = static_cast<std::size_t>(first - columns.begin());
  for (Eigen::Index i = 0; i < 6; ++i) {
    for (Eigen::Index j = i; j < 6; ++j, ++at) {
      EXPECT_NEAR(frames.back().record.at(at), expected(i, j), 1e-9 * expected.norm()) << i << j;
      EXPECT_EQ(frames.front().record.at(at), 0) << "the first pose is what it is told from";
    }
  }
  EXPECT_EQ(columns.at(at - 1), "covariance_tz_tz");
  EXPECT_GT(expected.ldlt().vectorD().minCoeff(), 0);
}

TEST(LidarEstimator, PosesAreOfTheBodyNotOfTheLidar) {
  const testing::SimulatedDrive drive(simulation::street(60, 1), 5, 10);
  testing::RandomMotion random(1);
  const geometry::Pose3 T_body_lidar = random.pose(1, 2);
  LidarEstimator estimator =
      make_estimator(quick_options(), recording_with(drive.scanner.profile, T_body_lidar));
  const auto frames = run(estimator, drive);
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_LT((frames[0].T_map_body.matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-12);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const geometry::Pose3 truth = T_body_lidar * drive.truth[i] * T_body_lidar.inverse();
    EXPECT_LT((frames[i].T_map_body.translation - truth.translation).norm(), 0.1) << i;
  }
}

TEST(LidarEstimator, UsedScansLieOnOneAnotherInTheMap) {
  // The same house corner seen by two scans: with deskew, body frame and pose right, scans that are
  // a metre apart agree. Checked on the ground, whose height in the body frame is known.
  const testing::SimulatedDrive drive(simulation::street(60, 1), 3, 10);
  geometry::Pose3 T_body_lidar;
  T_body_lidar.translation = {0, 0, 1.8};  // the body stands on the ground
  LidarEstimator estimator =
      make_estimator(quick_options(), recording_with(drive.scanner.profile, T_body_lidar));
  const auto frames = run(estimator, drive);
  const UsedScan used = estimator.used_scan(drive.scans[1], frames[1], true);
  EXPECT_EQ(used.feature_class.size(), used.x.size());
  EXPECT_EQ(used.intensity.size(), used.x.size());
  std::size_t near_ground = 0;
  for (std::size_t i = 0; i < used.x.size(); ++i) {
    if (std::abs(used.z[i]) < 0.1 && std::abs(used.x[i]) < 10) ++near_ground;
  }
  EXPECT_GT(near_ground, 1000U);
}

TEST(LidarEstimator, ColumnsAndRecordsAgree) {
  const testing::SimulatedDrive drive(simulation::street(60, 1), 3, 10);
  LidarEstimator estimator =
      make_estimator(quick_options(), recording_with(drive.scanner.profile, geometry::Pose3()));
  for (const PoseFrame& frame : run(estimator, drive)) {
    EXPECT_EQ(frame.record.size(), estimator.columns().size());
    EXPECT_GT(frame.milliseconds, 0);
  }
}

TEST(LidarEstimator, OtherSensorsAreNoFrames) {
  LidarEstimator estimator =
      make_estimator(quick_options(), recording_with(sensors::LidarProfile{}, geometry::Pose3()));
  EXPECT_TRUE(estimator.process(sensors::ImuSample{}).empty());
  auto other = std::make_shared<sensors::LidarScan>();
  other->sensor = "rear lidar";
  EXPECT_TRUE(estimator.process(std::shared_ptr<const sensors::LidarScan>(other)).empty());
  EXPECT_TRUE(estimator.finish().empty());
}

TEST(LidarEstimator, NeedsALidar) {
  dataset::RecordingInfo info;
  EXPECT_THROW(make_estimator(quick_options(), info), std::runtime_error);
}

}  // namespace
}  // namespace traverse::pipeline
