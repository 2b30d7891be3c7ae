#include "traverse/mapping/map_keyframe.hpp"

#include <fstream>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include "traverse/files/input_error.hpp"
#include "traverse/mapping/keyframe_map.hpp"

#include "geometry/random_motion.hpp"
#include "temporary_folder.hpp"

namespace traverse::mapping {
namespace {

TEST(ReadSimpleMap, ReadsBackWhatAKeyframeMapWrote) {
  const testing::TemporaryFolder folder;
  testing::RandomMotion random(1);
  MapKeyframe made;
  made.stamp = geometry::Stamp::from_seconds(1.3e9);
  made.sensor = "top";
  made.T_map_body = random.pose(1, 100);
  made.p_body_sensor = {0.5, 0, 1.75};
  made.x = {1, 2, 3};
  made.y = {-4, 5, 6};
  made.z = {0.5F, 0.25F, 8};
  made.intensity = {0.1F, 0.2F, 0.3F};
  made.time = {0, 0.05F, -0.02F};
  made.ring = {0, 7, 63};
  KeyframeMap map(KeyframeMapOptions{}, folder.path());
  map.add(made);
  map.write(folder / "map.simplemap");

  const auto keyframes = read_simple_map(folder / "map.simplemap");
  ASSERT_EQ(keyframes.size(), 1U);
  const MapKeyframe& read = keyframes[0];
  EXPECT_EQ(read.stamp, made.stamp);
  EXPECT_EQ(read.sensor, "top");
  EXPECT_LT((read.T_map_body.matrix() - made.T_map_body.matrix()).norm(), 1e-12);
  EXPECT_EQ(read.p_body_sensor, made.p_body_sensor);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(read.x[i], made.x[i], 1e-5);
    EXPECT_NEAR(read.y[i], made.y[i], 1e-5);
    EXPECT_NEAR(read.z[i], made.z[i], 1e-5);
  }
  EXPECT_EQ(read.intensity, made.intensity);
  EXPECT_EQ(read.time, made.time);
  EXPECT_EQ(read.ring, made.ring);
}

TEST(ReadSimpleMap, TakesWhatOtherProgramsOfMrptPutIntoOne) {
  const testing::TemporaryFolder folder;
  auto scan = mrpt::obs::CObservation2DRangeScan::Create();
  scan->aperture = 3.14F;
  scan->maxRange = 20;
  scan->sensorPose = mrpt::poses::CPose3D(0.2, 0, 0.4, 0, 0, 0);
  const std::vector<float> ranges{2, 3, 4};
  const std::vector<char> valid{1, 0, 1};
  scan->loadFromVectors(ranges.size(), ranges.data(), valid.data());
  auto frame = mrpt::obs::CSensoryFrame::Create();
  frame->insert(scan);
  mrpt::maps::CSimpleMap map;
  const mrpt::poses::CPose3DPDF::Ptr pose = mrpt::poses::CPose3DPDFGaussian::Create();
  map.insert(pose, frame);
  ASSERT_TRUE(map.saveToFile((folder / "plane.simplemap").string()));

  const auto keyframes = read_simple_map(folder / "plane.simplemap");
  ASSERT_EQ(keyframes.size(), 1U);
  ASSERT_EQ(keyframes[0].size(), 2U);
  EXPECT_NEAR((keyframes[0].p_body(1) - keyframes[0].p_body_sensor).norm(), 4, 1e-5);
  EXPECT_NEAR(keyframes[0].z[0], 0.4, 1e-6);
}

TEST(ReadSimpleMap, TakesOnlyTheMapPointsOfAKeyframeThatHasOthersToo) {
  const testing::TemporaryFolder folder;
  auto frame = mrpt::obs::CSensoryFrame::Create();
  for (const char* label : {"surface points", "map points"}) {
    auto points = mrpt::maps::CPointsMapXYZI::Create();
    points->insertPoint(1, 2, label[0] == 'm' ? 3.0F : 4.0F);
    auto cloud = mrpt::obs::CObservationPointCloud::Create();
    cloud->sensorLabel = label;
    cloud->pointcloud = points;
    frame->insert(cloud);
  }
  mrpt::maps::CSimpleMap map;
  const mrpt::poses::CPose3DPDF::Ptr pose = mrpt::poses::CPose3DPDFGaussian::Create();
  map.insert(pose, frame);
  ASSERT_TRUE(map.saveToFile((folder / "keyframes.simplemap").string()));
  const auto keyframes = read_simple_map(folder / "keyframes.simplemap");
  ASSERT_EQ(keyframes.size(), 1U);
  ASSERT_EQ(keyframes[0].size(), 1U);
  EXPECT_EQ(keyframes[0].z[0], 3);
}

TEST(ReadSimpleMap, SaysWhatAFileIsNot) {
  const testing::TemporaryFolder folder;
  EXPECT_THROW(read_simple_map(folder / "none.simplemap"), files::InputError);
  std::ofstream(folder / "text.simplemap") << "no map";
  EXPECT_THROW(read_simple_map(folder / "text.simplemap"), files::InputError);
  mrpt::maps::CSimpleMap empty;
  ASSERT_TRUE(empty.saveToFile((folder / "empty.simplemap").string()));
  EXPECT_THROW(read_simple_map(folder / "empty.simplemap"), files::InputError);
}

TEST(MapKeyframe, KeepsTheChosenPoints) {
  MapKeyframe keyframe;
  keyframe.x = keyframe.y = keyframe.z = keyframe.intensity = keyframe.time = {1, 2, 3};
  keyframe.ring = {1, 2, 3};
  keyframe.keep_only({1, 0, 1});
  EXPECT_EQ(keyframe.time, (std::vector<float>{1, 3}));
  EXPECT_EQ(keyframe.ring, (std::vector<std::uint16_t>{1, 3}));
  EXPECT_EQ(keyframe.x, (std::vector<float>{1, 3}));
  EXPECT_EQ(keyframe.intensity, (std::vector<float>{1, 3}));
}

}  // namespace
}  // namespace traverse::mapping
