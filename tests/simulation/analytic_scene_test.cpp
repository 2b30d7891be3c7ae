#include "traverse/simulation/analytic_scene.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "traverse/simulation/worlds.hpp"

namespace traverse::simulation {
namespace {

constexpr double kFar = 100;

TEST(AnalyticScene, RectangleIsMetWhereGeometrySays) {
  AnalyticScene scene;
  scene.add(Rectangle{{5, -1, -1}, {0, 2, 0}, {0, 0, 2}, 0.5});
  const auto hit = scene.first_hit({0, 0, 0}, Eigen::Vector3d(1, 0.1, 0).normalized(), kFar);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance_m, 5 * std::sqrt(1.01), 1e-12);
  EXPECT_LT((hit->normal - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-12);
  EXPECT_FALSE(scene.first_hit({0, 0, 0}, Eigen::Vector3d(1, 0.21, 0).normalized(), kFar));
  EXPECT_FALSE(scene.first_hit({0, 0, 0}, Eigen::Vector3d(-1, 0, 0), kFar));
  EXPECT_FALSE(scene.first_hit({0, 0, 0}, Eigen::Vector3d(0, 1, 0), kFar));
}

TEST(AnalyticScene, PoleIsMetOnItsNearSideWithinItsHeight) {
  AnalyticScene scene;
  scene.add(Pole{{10, 0, 0}, 0.5, 3, 0.5});
  EXPECT_NEAR(scene.first_hit({0, 0, 1}, {1, 0, 0}, kFar)->distance_m, 9.5, 1e-12);
  EXPECT_FALSE(scene.first_hit({0, 0, 3.1}, {1, 0, 0}, kFar));
  EXPECT_FALSE(scene.first_hit({0, 0.51, 1}, {1, 0, 0}, kFar));
  EXPECT_FALSE(scene.first_hit({0, 0, 1}, {0, 0, 1}, kFar));
}

TEST(AnalyticScene, TheNearestSurfaceHidesTheRest) {
  AnalyticScene scene;
  scene.add_box({10, 0, 0}, {2, 2, 2}, 0, 0.5);
  scene.add(Pole{{5, 0, 0}, 0.1, 3, 0.5});
  EXPECT_NEAR(scene.first_hit({0, 0, 1}, {1, 0, 0}, kFar)->distance_m, 4.9, 1e-12);
  EXPECT_NEAR(scene.first_hit({0, 0.5, 1}, {1, 0, 0}, kFar)->distance_m, 9, 1e-12);
  EXPECT_FALSE(scene.first_hit({0, 0.5, 1}, {1, 0, 0}, 8.9)) << "beyond the sensor's range";
}

TEST(Worlds, SameSeedSamePlaceAndSkyIsEmpty) {
  const AnalyticScene a = street(100, 3);
  const AnalyticScene b = street(100, 3);
  const AnalyticScene c = street(100, 4);
  ASSERT_EQ(a.rectangles().size(), b.rectangles().size());
  EXPECT_EQ(a.rectangles().back().corner, b.rectangles().back().corner);
  EXPECT_NE(a.rectangles().back().corner, c.rectangles().back().corner);
  EXPECT_FALSE(a.first_hit({0, 0, 1.8}, {0, 0, 1}, kFar));
}

}  // namespace
}  // namespace traverse::simulation
