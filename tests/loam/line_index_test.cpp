#include "traverse/loam/line_index.hpp"

#include <cstdlib>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "geometry/random_motion.hpp"

namespace traverse::loam {
namespace {

class LineIndexTest : public ::testing::Test {
 protected:
  static LinedPoints made_points() {
    testing::RandomMotion random(1);
    LinedPoints made;
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector3f p = random.vector(5).cast<float>();
      made.points.push_back(p.x(), p.y(), p.z(), 0);
      made.line.push_back(static_cast<std::uint16_t>(i / 50));
    }
    return made;
  }

  /// The same by looking at every point.
  std::optional<std::uint32_t> by_hand(const Eigen::Vector3d& query, double radius_m,
                                       const std::function<bool(std::uint32_t)>& accept) const {
    std::optional<std::uint32_t> best;
    double least = radius_m;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const double distance = (points.points.point(i) - query).norm();
      if (distance >= least || !accept(i)) continue;
      least = distance;
      best = i;
    }
    return best;
  }

  LinedPoints points = made_points();
  LineIndex index{points};
  testing::RandomMotion random{2};
};

TEST_F(LineIndexTest, FindsWhatLookingAtEveryPointFinds) {
  int found = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::Vector3d query = random.vector(6);
    const double radius_m = random.uniform(0.2, 4);
    const auto a = index.nearest(query, radius_m);
    EXPECT_EQ(a, by_hand(query, radius_m, [](std::uint32_t) { return true; }));
    if (!a) continue;
    ++found;
    const auto distance_to_a = [&](std::uint32_t i) {
      return (index.point(i) - index.point(*a)).norm();
    };
    EXPECT_EQ(index.nearest_along_line(query, radius_m, *a, 0.5),
              by_hand(query, radius_m, [&](std::uint32_t i) {
                return points.line[i] == points.line[*a] && distance_to_a(i) >= 0.5;
              }));
    EXPECT_EQ(index.nearest_across_lines(query, radius_m, *a, 2),
              by_hand(query, radius_m, [&](std::uint32_t i) {
                const int apart = std::abs(points.line[i] - points.line[*a]);
                return apart == 1 || apart == 2;
              }));
  }
  EXPECT_GT(found, 100);
}

TEST_F(LineIndexTest, APointIsNotItsOwnNeighbour) {
  const auto a = index.nearest(index.point(7), 1);
  EXPECT_EQ(a, 7U);
  EXPECT_NE(index.nearest_along_line(index.point(7), 10, 7, 0), 7U);
}

TEST_F(LineIndexTest, WithoutPointsOrWithoutAPlaceNothingIsFound) {
  EXPECT_EQ(LineIndex().nearest({0, 0, 0}, 100), std::nullopt);
  EXPECT_EQ(index.nearest({100, 0, 0}, 5), std::nullopt);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(index.nearest({nan, 0, 0}, 5), std::nullopt);
}

}  // namespace
}  // namespace traverse::loam
