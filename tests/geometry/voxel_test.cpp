#include "traverse/geometry/voxel.hpp"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace traverse::geometry
