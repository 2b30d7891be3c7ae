#include "traverse/voxel_map/line_map.hpp"

#include <gtest/gtest.h>

namespace traverse::voxel_map {
namespace {

/// A post at (10.3, 4.3), points every 5 cm.
LocalPoints post() {
  LocalPoints points;
  for (int i = 0; i < 24; ++i) {
    points.x.push_back(10.3F);
    points.y.push_back(4.3F);
    points.z.push_back(0.02F + 0.05F * static_cast<float>(i));
  }
  return points;
}

TEST(LineMap, AnswersOnceALineWasSeenInThreeFrames) {
  LineMap map({});
  const LocalPoints points = post();
  const CellGrid grid = map.grid(points.origin_map);
  const RelativeCell cell = grid.cell(10.3F, 4.3F, 0.3F);
  LineMap::Answer line{};
  map.insert(points);
  map.insert(points);
  EXPECT_FALSE(map.find(grid, cell, line)) << "may be passing by";
  map.insert(points);
  ASSERT_TRUE(map.find(grid, cell, line));
  const auto distance = [](const float* n, float d, float x, float y, float z) {
    return n[0] * x + n[1] * y + n[2] * z + d;
  };
  // On the line nothing, beside it the distance.
  EXPECT_NEAR(distance(line.n1, line.d1, 10.3F, 4.3F, 0.1F), 0, 1e-5);
  EXPECT_NEAR(distance(line.n2, line.d2, 10.3F, 4.3F, 0.5F), 0, 1e-5);
  EXPECT_NEAR(std::hypot(distance(line.n1, line.d1, 10.6F, 4.7F, 0.3F),
                         distance(line.n2, line.d2, 10.6F, 4.7F, 0.3F)),
              0.5, 1e-5);
}

TEST(LineMap, DropsWhatIsFar) {
  LineMap map({});
  map.insert(post());
  EXPECT_GT(map.size(), 0U);
  map.keep_near({50, 0, 0}, 60);
  EXPECT_GT(map.size(), 0U);
  map.keep_near({200, 0, 0}, 60);
  EXPECT_EQ(map.size(), 0U);
}

}  // namespace
}  // namespace traverse::voxel_map
