#include "traverse/mapping/voxel_map.hpp"

#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/point_cloud_file.hpp"
#include "traverse/files/input_error.hpp"

#include "file_size_limit.hpp"
#include "temporary_folder.hpp"

namespace traverse::mapping {
namespace {

using ::testing::ElementsAre;

TEST(VoxelMap, KeepsTheFirstPointOfEachVoxelInTheMapFrame) {
  VoxelMap map(1, 1000);
  geometry::Pose3 T_map_body;
  T_map_body.translation = {10, 0, 0};
  const std::vector<float> x{0.1F, 0.9F, 1.5F};
  const std::vector<float> zero(3, 0.5F);
  const std::vector<float> intensity{0.2F, 0.3F, 0.4F};
  map.insert(x, zero, zero, intensity, T_map_body);
  ASSERT_EQ(map.size(), 2U);
  EXPECT_FLOAT_EQ(map.points()[0].x(), 10.1F);
  EXPECT_FLOAT_EQ(map.points()[1].x(), 11.5F);
  EXPECT_THAT(map.intensities(), ElementsAre(0.2F, 0.4F));
}

TEST(VoxelMap, DoublesItsVoxelsRatherThanGrowWithoutBound) {
  VoxelMap map(0.1, 500);
  for (int scan = 0; scan < 50; ++scan) {
    std::vector<float> x, y, z;
    for (int i = 0; i < 100; ++i) {
      x.push_back(static_cast<float>(scan) + 0.01F * static_cast<float>(i));
      y.push_back(0.13F * static_cast<float>(i % 10));
      z.push_back(0);
    }
    map.insert(x, y, z, {}, geometry::Pose3());
    EXPECT_LE(map.size(), 600U);
  }
  EXPECT_GT(map.voxel_m(), 0.1);
  EXPECT_GT(map.size(), 50U);
}

TEST(VoxelMap, IsReadBackFromPly) {
  const testing::TemporaryFolder folder;
  VoxelMap map(0.1, 1000);
  const std::vector<float> x{1, 2};
  const std::vector<float> y{3, 4};
  const std::vector<float> z{5, 6};
  map.insert(x, y, z, {}, geometry::Pose3());
  map.write_ply(folder / "map.ply");
  const dataset::PointCloud cloud = dataset::read_point_cloud(folder / "map.ply");
  EXPECT_EQ(cloud.size(), 2U);
  EXPECT_THAT(dataset::to_floats(*cloud.find("z")), ElementsAre(5, 6));
  EXPECT_THAT(dataset::to_floats(*cloud.find("intensity")), ElementsAre(0, 0));
}

TEST(VoxelMap, RefusesArraysOfDifferentSize) {
  VoxelMap map(0.1, 1000);
  const std::vector<float> two{1, 2};
  const std::vector<float> one{1};
  EXPECT_THROW(map.insert(two, two, one, {}, geometry::Pose3()), std::invalid_argument);
  EXPECT_THROW(map.insert(two, two, two, one, geometry::Pose3()), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::mapping
