#include "traverse/geometry/umeyama.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"

namespace traverse::geometry {
namespace {

using testing::RandomMotion;

std::vector<Eigen::Vector3d> random_points(RandomMotion& random, int count) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) points.push_back(random.vector(20));
  return points;
}

TEST(Umeyama, FindsTheSimilarityThatMadeThePoints) {
  RandomMotion random(1);
  const Pose3 T = random.pose(3, 50);
  const auto x = random_points(random, 20);
  std::vector<Eigen::Vector3d> y;
  for (const auto& p : x) y.push_back(1.7 * (T.rotation * p) + T.translation);
  const Similarity found = umeyama(x, y, true);
  EXPECT_NEAR(found.scale, 1.7, 1e-13);
  EXPECT_LT((found.T_y_x.matrix() - T.matrix()).norm(), 1e-11);
}

TEST(Umeyama, WithoutScaleKeepsLengths) {
  RandomMotion random(2);
  const auto x = random_points(random, 20);
  std::vector<Eigen::Vector3d> y;
  for (const auto& p : x) y.push_back(2 * p);
  EXPECT_EQ(umeyama(x, y, false).scale, 1);
}

TEST(Umeyama, NeverMirrors) {
  RandomMotion random(3);
  const auto x = random_points(random, 20);
  std::vector<Eigen::Vector3d> y;
  for (const auto& p : x) y.emplace_back(p.x(), p.y(), -p.z());
  EXPECT_NEAR(umeyama(x, y, false).T_y_x.rotation.determinant(), 1, 1e-12);
}

TEST(Umeyama, RefusesPointsThatAreNotFinite) {
  RandomMotion random(4);
  auto x = random_points(random, 5);
  const auto y = x;
  x[2].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(umeyama(x, y, false), std::invalid_argument);
}

TEST(Umeyama, RefusesPointsOnALine) {
  std::vector<Eigen::Vector3d> x;
  for (int i = 0; i < 5; ++i) x.emplace_back(i, 0, 0);
  EXPECT_THROW(umeyama(x, x, false), DegenerateAlignment);
  EXPECT_THROW(umeyama({}, {}, false), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::geometry
