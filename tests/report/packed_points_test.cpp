#include "page/packed_points.hpp"

#include <random>

#include <gtest/gtest.h>

namespace traverse::report {
namespace {

ScenePoints plane(std::size_t count) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<float> metres(0, 100);
  ScenePoints points;
  for (std::size_t i = 0; i < count; ++i) {
    points.positions.emplace_back(metres(generator), metres(generator), 0.0F);
    points.intensities.push_back(static_cast<float>(i));
  }
  return points;
}

TEST(Thinned, KeepsAllWhereTheyFit) {
  double voxel_m = 1;
  EXPECT_EQ(thinned(plane(100), 100, voxel_m).positions.size(), 100U);
  EXPECT_EQ(voxel_m, 0);
}

TEST(Thinned, KeepsAtMostSoManyAndNotMuchFewer) {
  double voxel_m = 0;
  const ScenePoints points = thinned(plane(100'000), 20'000, voxel_m);
  EXPECT_LE(points.positions.size(), 20'000U);
  EXPECT_GE(points.positions.size(), 10'000U);
  EXPECT_EQ(points.intensities.size(), points.positions.size());
  EXPECT_GT(voxel_m, 0.25);
}

TEST(Pack, ResolvesTheLargestExtentIn16Bits) {
  const PackedPoints packed = pack(plane(1000), std::vector<std::uint16_t>(1000, 0));
  EXPECT_EQ(packed.count, 1000U);
  EXPECT_NEAR(packed.step_m, 100.0 / 65535, 1e-4);
  EXPECT_EQ(packed.intensity[1], 999);
  EXPECT_FALSE(packed.base64.empty());
  EXPECT_EQ(pack({}, {}).count, 0U);
}

}  // namespace
}  // namespace traverse::report
