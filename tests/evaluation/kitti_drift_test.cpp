#include "traverse/evaluation/kitti_drift.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "traverse/evaluation/association.hpp"
#include "traverse/geometry/so3.hpp"

#include "evaluation/golden_trajectories.hpp"

namespace traverse::evaluation {
namespace {

using geometry::Pose3;
using DrivePoses = std::vector<Pose3>;

/// A straight drive along x, `step_m` from pose to pose.
DrivePoses straight(std::size_t count, double step_m) {
  DrivePoses poses;
  for (std::size_t i = 0; i < count; ++i) {
    poses.push_back({Eigen::Matrix3d::Identity(), {step_m * static_cast<double>(i), 0, 0}});
  }
  return poses;
}

DrivePoses turning_by(DrivePoses poses, double rad_per_pose) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].rotation = geometry::exp_so3({0, 0, rad_per_pose * static_cast<double>(i)});
  }
  return poses;
}

TEST(KittiDrift, MeasuresALengthErrorInPercent) {
  // 100 m is first exceeded one pose after it: 101 m are driven and divided by the nominal 100.
  const auto drift = kitti_drift(straight(250, 1.01), straight(250, 1), {});
  ASSERT_TRUE(drift);
  const KittiSegment& segment = drift->segments.front();
  EXPECT_EQ(segment.first, 0U);
  EXPECT_EQ(segment.last, 101U);
  EXPECT_EQ(segment.length_m, 100);
  EXPECT_NEAR(segment.translation_percent, 1.01, 1e-12);
  EXPECT_NEAR(segment.speed_mps, 100 / (0.1 * 102), 1e-12);
  EXPECT_EQ(segment.rotation_deg_per_m, 0);
}

TEST(KittiDrift, MeasuresARotationErrorPerMetre) {
  const auto drift = kitti_drift(turning_by(straight(150, 1), 1e-3), straight(150, 1), {});
  ASSERT_TRUE(drift);
  EXPECT_NEAR(drift->segments.front().rotation_deg_per_m, 0.101 / 100 * 180 / std::numbers::pi,
              1e-12);
}

TEST(KittiDrift, BinsSegmentsByLengthAndBySpeed) {
  const auto drift = kitti_drift(straight(251, 1.01), straight(251, 1), {});
  ASSERT_TRUE(drift);
  // 100 m from 0, 10, ... 140; 200 m from 0, 10, ... 40.
  ASSERT_EQ(drift->by_length.size(), 2U);
  EXPECT_EQ(drift->by_length[0].centre, 100);
  EXPECT_EQ(drift->by_length[0].segments, 15U);
  EXPECT_EQ(drift->by_length[1].segments, 5U);
  EXPECT_EQ(drift->segments.size(), 20U);
  EXPECT_NEAR(drift->translation_percent, (15 * 1.01 + 5 * 1.005) / 20, 1e-12);
  // About 9.8 m/s: in the bins around 8 and 10, not in that around 12.
  ASSERT_EQ(drift->by_speed.size(), 2U);
  EXPECT_EQ(drift->by_speed[0].centre, 8);
  EXPECT_EQ(drift->by_speed[1].centre, 10);
  EXPECT_EQ(drift->by_speed[1].segments, 20U);
}

TEST(KittiDrift, IsNotDefinedUpToAHundredMetres) {
  EXPECT_FALSE(kitti_drift(straight(101, 1), straight(101, 1), {}));
  EXPECT_TRUE(kitti_drift(straight(102, 1), straight(102, 1), {}));
  EXPECT_FALSE(kitti_drift(straight(1, 1), straight(1, 1), {}));
}

TEST(KittiDrift, DependsOnTheFrameAndNamesIt) {
  const auto estimate = testing::golden_estimate();
  const auto reference = testing::golden_reference();
  const Association association = associate(estimate, reference, {});
  const MatchedPoses poses = matched_poses(estimate, reference, association.matches);
  KittiDriftOptions options;
  options.body_frame = "lidar";
  const auto in_lidar = kitti_drift(poses.estimate, poses.reference, options);
  // The camera of the KITTI car: 0.27 m ahead of the lidar, 0.08 m below, z forward.
  Pose3 T_body_camera;
  T_body_camera.rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  T_body_camera.translation << 0.27, 0, -0.08;
  options.T_body_camera = T_body_camera;
  const auto in_camera = kitti_drift(poses.estimate, poses.reference, options);
  ASSERT_TRUE(in_lidar && in_camera);
  EXPECT_EQ(in_lidar->frame, "lidar");
  EXPECT_EQ(in_camera->frame, "camera");
  EXPECT_NEAR(in_lidar->translation_percent, 2.1116, 5e-5);
  EXPECT_NEAR(in_camera->translation_percent, 2.1094, 5e-5);
  EXPECT_NEAR(in_camera->rotation_deg_per_m, in_lidar->rotation_deg_per_m, 1e-12);
}

TEST(KittiDrift, RefusesStepsThatLeadNowhere) {
  KittiDriftOptions options;
  options.step = 0;
  EXPECT_THROW(kitti_drift(straight(3, 1), straight(3, 1), options), std::invalid_argument);
  options = {};
  options.frame_seconds = 0;
  EXPECT_THROW(kitti_drift(straight(3, 1), straight(3, 1), options), std::invalid_argument);
  EXPECT_THROW(kitti_drift(straight(3, 1), straight(4, 1), {}), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::evaluation
