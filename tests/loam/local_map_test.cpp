#include "traverse/loam/local_map.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"

namespace traverse::loam {
namespace {

using testing::RandomMotion;

std::vector<Eigen::Vector3d> random_points(int count, double extent) {
  RandomMotion random(1);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) points.push_back(random.vector(extent));
  return points;
}

TEST(LocalMap, KeepsTheMeanOfEachVoxel) {
  LocalMap map(1, 100);
  map.insert(std::vector<Eigen::Vector3d>{{0.2, 0.5, 0.5}, {0.4, 0.5, 0.5}, {0.9, 0.5, 0.5}});
  map.insert(std::vector<Eigen::Vector3d>{{-0.5, 0.5, 0.5}});
  ASSERT_EQ(map.size(), 2U);
  EXPECT_NEAR(map.points()[0].x(), 0.5, 1e-12);
  EXPECT_NEAR(map.points()[1].x(), -0.5, 1e-12);
}

TEST(LocalMap, NearestAgreesWithLookingAtEveryPoint) {
  LocalMap map(0.01, 100);
  map.insert(random_points(2000, 5));
  map.build_index();
  RandomMotion random(7);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Vector3d query = random.vector(5);
    std::vector<double> distances;
    for (const auto& p : map.points()) distances.push_back((p - query).norm());
    std::sort(distances.begin(), distances.end());
    const auto within = static_cast<std::size_t>(
        std::lower_bound(distances.begin(), distances.end(), 0.6) - distances.begin());
    std::array<std::uint32_t, 5> found{};
    const std::size_t count = map.nearest(query, 0.6, found);
    ASSERT_EQ(count, std::min<std::size_t>(5, within));
    for (std::size_t k = 0; k < count; ++k) {
      EXPECT_NEAR((map.points()[found[k]] - query).norm(), distances[k], 1e-12);
    }
  }
}

TEST(LocalMap, ForgetsWhatIsFarBehindSoThatALongDriveStaysBounded) {
  LocalMap map(0.5, 20);
  std::size_t largest = 0;
  for (int metre = 0; metre < 500; ++metre) {
    std::vector<Eigen::Vector3d> wall;
    for (int k = 0; k < 20; ++k) wall.emplace_back(metre, 5, 0.5 * k);
    map.insert(wall);
    map.follow({static_cast<double>(metre), 0, 0});
    largest = std::max(largest, map.size());
  }
  EXPECT_LE(largest, 20U * 24U);
  for (const auto& p : map.points()) EXPECT_GT(p.x(), 475);
}

TEST(LocalMap, ACopyIsIndependentAndInsertGoesOnAfterForgetting) {
  LocalMap map(1, 10);
  map.insert(std::vector<Eigen::Vector3d>{{0.5, 0.5, 0.5}, {30, 0.5, 0.5}});
  LocalMap copy = map;
  copy.follow({30, 0, 0});
  EXPECT_EQ(copy.size(), 1U);
  EXPECT_EQ(map.size(), 2U);
  copy.insert(std::vector<Eigen::Vector3d>{{30.5, 0.5, 0.5}});  // its voxel is still known
  ASSERT_EQ(copy.size(), 1U);
  EXPECT_NEAR(copy.points()[0].x(), 30.25, 1e-12);
}

TEST(LocalMap, WithoutPointsOrIndexNothingIsNear) {
  LocalMap map(1, 10);
  std::array<std::uint32_t, 5> found{};
  EXPECT_EQ(map.nearest({0, 0, 0}, 1, found), 0U);
  map.build_index();
  EXPECT_EQ(map.nearest({0, 0, 0}, 1, found), 0U);
}

}  // namespace
}  // namespace traverse::loam
