#include "traverse/mapping/keyframe_map.hpp"

#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDF.h>

#include "traverse/files/input_error.hpp"

#include "file_size_limit.hpp"
#include "geometry/random_motion.hpp"
#include "temporary_folder.hpp"

namespace traverse::mapping {
namespace {

/// A map of two keyframes with three points each.
KeyframeMap made_map(const std::filesystem::path& scratch, const geometry::Pose3& T_map_first,
                     const geometry::Pose3& T_map_second) {
  KeyframeMap map(KeyframeMapOptions{}, scratch);
  MapKeyframe keyframe;
  keyframe.stamp = geometry::Stamp::from_seconds(1.3e9);
  keyframe.sensor = "lidar";
  keyframe.T_map_body = T_map_first;
  keyframe.x = keyframe.y = keyframe.z = {1, 2, 3};
  keyframe.intensity = {0.1F, 0.2F, 0.3F};
  map.add(keyframe);
  keyframe.stamp = geometry::Stamp::from_seconds(1.3e9 + 1);
  keyframe.T_map_body = T_map_second;
  map.add(keyframe);
  return map;
}

TEST(KeyframeMap, WantsAKeyframeAfterMotionOrRotation) {
  const testing::TemporaryFolder folder;
  KeyframeMap map(KeyframeMapOptions{}, folder.path());
  geometry::Pose3 pose;
  EXPECT_TRUE(map.wants(pose));
  map.add(MapKeyframe{});
  pose.translation.x() = 1.9;
  EXPECT_FALSE(map.wants(pose));
  pose.translation.x() = 2.1;
  EXPECT_TRUE(map.wants(pose));
  pose.translation.x() = 0;
  pose.rotation = geometry::exp_so3({0, 0, 0.31});
  EXPECT_TRUE(map.wants(pose));
}

TEST(KeyframeMap, IsOpenedByMrptWithPosesAndPoints) {
  const testing::TemporaryFolder folder;
  testing::RandomMotion random(1);
  const geometry::Pose3 T_map_second = random.pose(1, 10);
  made_map(folder.path(), geometry::Pose3(), T_map_second).write(folder / "map.simplemap");

  mrpt::maps::CSimpleMap loaded;
  ASSERT_TRUE(loaded.loadFromFile((folder / "map.simplemap").string()));
  ASSERT_EQ(loaded.size(), 2U);
  mrpt::poses::CPose3DPDF::Ptr pose;
  mrpt::obs::CSensoryFrame::Ptr frame;
  loaded.get(1, pose, frame);
  const auto mean = pose->getMeanVal();
  EXPECT_NEAR(mean.x(), T_map_second.translation.x(), 1e-12);
  EXPECT_NEAR(mean.z(), T_map_second.translation.z(), 1e-12);
  const auto observation = frame->getObservationByClass<mrpt::obs::CObservationPointCloud>();
  ASSERT_TRUE(observation);
  EXPECT_EQ(observation->sensorLabel, "lidar");
  EXPECT_EQ(observation->pointcloud->size(), 3U);
}

TEST(KeyframeMap, HoldsCloudsThatMrpt3ReadsAndLosesNothingOfThem) {
  const testing::TemporaryFolder folder;
  made_map(folder.path(), {}, {}).write(folder / "map.simplemap");
  mrpt::maps::CSimpleMap loaded;
  ASSERT_TRUE(loaded.loadFromFile((folder / "map.simplemap").string()));
  mrpt::poses::CPose3DPDF::Ptr pose;
  mrpt::obs::CSensoryFrame::Ptr frame;
  loaded.get(0, pose, frame);
  const auto observation = frame->getObservationByClass<mrpt::obs::CObservationPointCloud>();
  ASSERT_TRUE(observation);
  EXPECT_STREQ(observation->pointcloud->GetRuntimeClass()->className,
               "mrpt::maps::CSimplePointsMap");
  const std::vector<MapKeyframe> keyframes = read_simple_map(folder / "map.simplemap");
  ASSERT_EQ(keyframes.size(), 2U);
  EXPECT_EQ(keyframes[0].intensity, (std::vector<float>{0.1F, 0.2F, 0.3F}));
}

TEST(KeyframeMap, AFullDiskIsAnErrorAndLeavesNothing) {
  const testing::TemporaryFolder folder;
  KeyframeMap map(KeyframeMapOptions{}, folder.path());
  testing::RandomMotion random(2);
  MapKeyframe keyframe;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3f p = random.vector(50).cast<float>();
    keyframe.x.push_back(p.x());
    keyframe.y.push_back(p.y());
    keyframe.z.push_back(p.z());
  }
  map.add(keyframe);
  {
    const testing::FileSizeLimit limit(4096);
    EXPECT_THROW(map.write(folder / "map.simplemap"), files::OutputError);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace traverse::mapping
