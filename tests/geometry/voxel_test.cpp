#include "traverse/geometry/voxel.hpp"

#include <cmath>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "traverse/geometry/voxel_set.hpp"

namespace traverse::geometry {
namespace {

TEST(VoxelKey, IsTheFloorOnEachAxisAlsoBelowZero) {
  EXPECT_EQ(voxel_key({0.01, 0.01, 0.01}, 0.2), voxel_key({0.19, 0.19, 0.19}, 0.2));
  EXPECT_NE(voxel_key({0.01, 0, 0}, 0.2), voxel_key({-0.01, 0, 0}, 0.2));
  EXPECT_EQ(voxel_key({-0.01, 0, 0}, 0.2), voxel_key({-0.19, 0, 0}, 0.2));
}

TEST(VoxelKey, DiffersForAllCellsAround) {
  std::set<std::uint64_t> keys;
  for (int x = -3; x <= 3; ++x) {
    for (int y = -3; y <= 3; ++y) {
      for (int z = -3; z <= 3; ++z) keys.insert(voxel_key({x + 0.5, y + 0.5, z + 0.5}, 1));
    }
  }
  EXPECT_EQ(keys.size(), 343U);
}

TEST(VoxelKey, CoordinatesBeyondAllCountingShareACell) {
  EXPECT_EQ(voxel_key({1e300, -1e300, std::nan("")}, 0.2), voxel_key({0, 0, 0}, 0.2));
}

TEST(VoxelSet, TellsTheFirstPointOfEachVoxelFromThoseThatFollow) {
  VoxelSet voxels(0.5);
  EXPECT_TRUE(voxels.insert({0.1, 0.1, 0.1}));
  EXPECT_FALSE(voxels.insert({0.4, 0.4, 0.4}));
  EXPECT_FALSE(voxels.insert({0.1, 0.1, 0.1}));
  EXPECT_TRUE(voxels.insert({0.1, 0.1, -0.1})) << "below zero is another voxel";
  EXPECT_TRUE(voxels.insert({0.6, 0.1, 0.1}));
  EXPECT_EQ(voxels.size(), 3U);
}

TEST(VoxelSet, HoldsMoreThanWasSaid) {
  VoxelSet voxels(1, 2);
  for (int x = 0; x < 1000; ++x) EXPECT_TRUE(voxels.insert({x + 0.5, 0, 0}));
  for (int x = 0; x < 1000; ++x) EXPECT_FALSE(voxels.insert({x + 0.25, 0, 0}));
  VoxelSet moved = std::move(voxels);
  EXPECT_EQ(moved.size(), 1000U);
  moved = VoxelSet(1);
  EXPECT_TRUE(moved.insert({0.5, 0, 0}));
}

}  // namespace
}  // namespace traverse::geometry
