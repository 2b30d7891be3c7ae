#include "traverse/render/camera.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace traverse::render {
namespace {

const Rect kViewport{100, 50, 500, 250};

TEST(Camera, FromAboveIsTrueToScaleWithYUp) {
  const Camera camera = Camera::from_above({10, 20}, 40, 20, -2, 8);
  const Point centre = camera.project({10, 20, 0}, kViewport);
  EXPECT_NEAR(centre.x, 300, 1e-9);
  EXPECT_NEAR(centre.y, 150, 1e-9);
  const Point right_and_up = camera.project({30, 30, 5}, kViewport);
  EXPECT_NEAR(right_and_up.x, 400, 1e-9);
  EXPECT_NEAR(right_and_up.y, 100, 1e-9);
  EXPECT_LT(camera.depth({0, 0, 8}), camera.depth({0, 0, -2}));
  EXPECT_GT(camera.depth({0, 0, 8}), camera.near);
  EXPECT_LT(camera.depth({0, 0, -2}), camera.far);
}

TEST(Camera, LookingAtPutsTheTargetInTheMiddleAndFarThingsCloser) {
  const Camera camera =
      Camera::looking_at({-10, 0, 10}, {0, 0, 0}, std::numbers::pi / 3, 2, 1, 100);
  const Point target = camera.project({0, 0, 0}, kViewport);
  EXPECT_NEAR(target.x, 300, 1e-9);
  EXPECT_NEAR(target.y, 150, 1e-9);
  EXPECT_NEAR(camera.depth({0, 0, 0}), std::sqrt(200.0), 1e-12);
  const double near_width =
      camera.project({0, -1, 0}, kViewport).x - camera.project({0, 1, 0}, kViewport).x;
  const double far_width =
      camera.project({50, -1, 0}, kViewport).x - camera.project({50, 1, 0}, kViewport).x;
  EXPECT_GT(near_width, 2 * far_width);
  EXPECT_GT(far_width, 0);                                      // y to the left
  EXPECT_LT(camera.project({0, 0, 1}, kViewport).y, target.y);  // z up
}

}  // namespace
}  // namespace traverse::render
