#include "traverse/voxel_map/plane_map.hpp"

#include <random>

#include <gtest/gtest.h>

#include "traverse/parallel/workers.hpp"

namespace traverse::voxel_map {
namespace {

/// Points of the plane z = 0.2 x + 1 around `centre`, exact to floats, in local coordinates.
LocalPoints slope(const Eigen::Vector3d& centre, double half_width, int count) {
  LocalPoints points;
  points.origin_map = origin_near(centre);
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> offset(-half_width, half_width);
  for (int i = 0; i < count; ++i) {
    const double x = centre.x() + offset(generator);
    const double y = centre.y() + offset(generator);
    points.x.push_back(static_cast<float>(x - points.origin_map.x()));
    points.y.push_back(static_cast<float>(y - points.origin_map.y()));
    points.z.push_back(static_cast<float>(0.2 * x + 1 - points.origin_map.z()));
  }
  return points;
}

class PlaneMapFarAndNear : public ::testing::TestWithParam<double> {};

TEST_P(PlaneMapFarAndNear, AnswersWithThePlaneOfTheCell) {
  parallel::Workers workers(1);
  PlaneMap map({});
  const Eigen::Vector3d centre(GetParam(), -0.5 * GetParam(), 0.2 * GetParam() + 1);
  const LocalPoints points = slope(centre, 2, 2000);
  map.insert(points, workers);
  const CellGrid grid = map.grid(points.origin_map);
  std::size_t found = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    PlaneMap::Answer plane{};
    if (!map.find(grid, grid.cell(points.x[i], points.y[i], points.z[i]), plane)) continue;
    ++found;
    const float r =
        plane.nx * points.x[i] + plane.ny * points.y[i] + plane.nz * points.z[i] + plane.d;
    EXPECT_NEAR(r, 0, 1e-4);
    EXPECT_NEAR(std::abs(plane.nz), 1 / std::sqrt(1.04), 1e-4);
  }
  EXPECT_GT(found, points.size() * 9 / 10);
}

INSTANTIATE_TEST_SUITE_P(Positions, PlaneMapFarAndNear, ::testing::Values(0, 77.3, -77.3, 12345.6));

TEST(PlaneMap, TheParentAnswersWhereACellHasTooFewPoints) {
  parallel::Workers workers(1);
  PlaneMap map({});
  LocalPoints points;
  points.origin_map = kGridAnchor_map;
  for (int i = 0; i < 6; ++i) {  // four to nine points in each 0.5 m cell of one parent cell
    for (int j = 0; j < 6; ++j) {
      points.x.push_back(0.13F + 0.25F * static_cast<float>(i));
      points.y.push_back(0.13F + 0.25F * static_cast<float>(j));
      points.z.push_back(0.1F);
    }
  }
  map.insert(points, workers);
  const CellGrid grid = map.grid(points.origin_map);
  PlaneMap::Answer plane{};
  ASSERT_TRUE(map.find(grid, grid.cell(0.7F, 0.7F, 0.1F), plane));
  EXPECT_NEAR(std::abs(plane.nz), 1, 1e-6);
  EXPECT_NEAR(plane.nz * 0.1F + plane.d, 0, 1e-6);
  EXPECT_TRUE(map.find(grid, grid.cell(0.7F, 0.7F, 0.6F), plane)) << "an empty cell of the parent";
  EXPECT_FALSE(map.find(grid, grid.cell(0.7F, 0.7F, 1.6F), plane));
}

TEST(PlaneMap, DropsWhatIsFar) {
  parallel::Workers workers(1);
  PlaneMap map({});
  map.insert(slope({0, 0, 1}, 5, 5000), workers);
  map.insert(slope({200, 0, 41}, 5, 5000), workers);
  const std::size_t both = map.size();
  map.keep_near({200, 0, 41}, 100, workers);
  EXPECT_GT(map.size(), both / 3);
  EXPECT_LT(map.size(), both * 2 / 3);
  const LocalPoints kept = slope({200, 0, 41}, 4, 500);
  const CellGrid grid = map.grid(kept.origin_map);
  PlaneMap::Answer plane{};
  EXPECT_TRUE(map.find(grid, grid.cell(kept.x[0], kept.y[0], kept.z[0]), plane));
}

TEST(PlaneMap, IsTheSameForAnyNumberOfThreads) {
  const LocalPoints points = slope({3, 4, 1.6}, 30, 30000);
  PlaneMap serial({});
  parallel::Workers one(1);
  parallel::Workers four(4);
  for (int frame = 0; frame < 3; ++frame) serial.insert(points, one);
  PlaneMap parallel({});
  for (int frame = 0; frame < 3; ++frame) parallel.insert(points, four);
  ASSERT_EQ(serial.size(), parallel.size());
  const CellGrid grid = serial.grid(points.origin_map);
  for (std::size_t i = 0; i < points.size(); i += 7) {
    const RelativeCell cell = grid.cell(points.x[i], points.y[i], points.z[i]);
    PlaneMap::Answer a{};
    PlaneMap::Answer b{};
    ASSERT_EQ(serial.find(grid, cell, a), parallel.find(grid, cell, b));
    EXPECT_EQ(a.nx, b.nx);
    EXPECT_EQ(a.d, b.d);
    EXPECT_EQ(a.variance, b.variance);
  }
}

TEST(PlaneMap, StandingStillForHoursKeepsThePlane) {
  parallel::Workers workers(1);
  PlaneMap map({});
  const LocalPoints points = slope(kGridAnchor_map + Eigen::Vector3d(0.2, 0.2, 1.2), 0.2, 500);
  for (int frame = 0; frame < 2000; ++frame) map.insert(points, workers);  // a million points
  const CellGrid grid = map.grid(points.origin_map);
  PlaneMap::Answer plane{};
  ASSERT_TRUE(map.find(grid, grid.cell(points.x[0], points.y[0], points.z[0]), plane));
  EXPECT_NEAR(plane.nx * points.x[0] + plane.ny * points.y[0] + plane.nz * points.z[0] + plane.d, 0,
              1e-3);
}

}  // namespace
}  // namespace traverse::voxel_map
