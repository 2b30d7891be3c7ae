#include "traverse/slam/keyframe_maker.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "slam/made_drive.hpp"

namespace traverse::slam {
namespace {

using testing::MadeDrive;

TEST(KeyframeMaker, MakesOneAfterEnoughMotionOrRotation) {
  const sensors::LidarProfile profile = testing::coarse_scanner().profile;
  KeyframeMaker maker({}, profile);
  lidar::Frame frame;
  frame.health = testing::good_health();
  EXPECT_TRUE(maker.observe(frame));  // the first
  sensors::LidarScan scan;
  maker.make(frame, scan, {}, true);
  frame.T_map_lidar.translation.x() = 1.9;
  EXPECT_FALSE(maker.observe(frame));
  frame.T_map_lidar.translation.x() = 2.1;
  EXPECT_TRUE(maker.observe(frame));
  frame.T_map_lidar = geometry::Pose3::identity();
  frame.T_map_lidar.rotation = geometry::exp_so3({0, 0, 0.4});
  EXPECT_TRUE(maker.observe(frame));
}

TEST(KeyframeMaker, FeaturesStandStillAtTheStamp) {
  MadeDrive drive(geometry::Twist::Zero());
  drive.pass(0.2, simulation::Drive{});
  const auto& made = drive.frames().front();
  KeyframeMaker maker({}, drive.profile());
  maker.observe(made.frame);
  const Keyframe keyframe =
      maker.make(made.frame, made.scan, testing::points_of(made, drive.profile()), true);
  ASSERT_GT(keyframe.features.planar.size(), 100U);
  ASSERT_GT(keyframe.points.size(), 1000U);
  EXPECT_EQ(keyframe.points.ring.size(), keyframe.points.size());
  for (const float time : keyframe.features.planar.time) EXPECT_EQ(time, 0);
}

TEST(KeyframeMaker, DeskewCarriesAPointAlongTheMotion) {
  voxel_map::SweepSample sample;
  sample.edges.push_back(10, 2, 1, 10.2F, 0);
  sample.edges.time = {0.05F};
  geometry::Twist velocity;
  velocity << 0, 0, 0.4, 12, 0, 0.5;
  const auto still = deskewed(sample, velocity);
  const Eigen::Vector3d expected = geometry::exp_se3(0.05 * velocity) * Eigen::Vector3d(10, 2, 1);
  EXPECT_NEAR(still.edges.x[0], expected.x(), 1e-4);
  EXPECT_NEAR(still.edges.y[0], expected.y(), 1e-4);
  EXPECT_NEAR(still.edges.z[0], expected.z(), 1e-4);
}

TEST(KeyframeMaker, LostFramesMakeTheStepUncertain) {
  const sensors::LidarProfile profile = testing::coarse_scanner().profile;
  const auto sigma_after = [&](int lost) {
    KeyframeMaker maker({}, profile);
    lidar::Frame frame;
    frame.health = testing::good_health();
    maker.observe(frame);
    maker.make(frame, {}, {}, true);
    for (int i = 0; i < lost; ++i) {
      frame.health.registered = false;
      maker.observe(frame);
    }
    frame.health.registered = true;
    frame.T_map_lidar.translation.x() = 3;
    maker.observe(frame);
    return std::sqrt(maker.make(frame, {}, {}, true).step_covariance(3, 3));
  };
  EXPECT_LT(sigma_after(0), 0.05);
  EXPECT_GT(sigma_after(2), 0.9);
}

}  // namespace
}  // namespace traverse::slam
