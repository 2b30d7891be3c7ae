#include "plot/decimation.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/no_number.hpp"

namespace traverse::render {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;

TEST(Decimation, KeepsFirstLowestHighestAndLastOfAColumn) {
  const std::vector<Point> points{{5.1, 3}, {5.2, 9}, {5.3, 4}, {5.4, -2}, {5.5, 5}, {5.6, 1}};
  EXPECT_THAT(decimated(points),
              ElementsAre(Point{5.1, 3}, Point{5.2, 9}, Point{5.4, -2}, Point{5.6, 1}));
}

TEST(Decimation, ASinglePeakSurvivesAmongAMillion) {
  std::vector<Point> points(1'000'000);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = {static_cast<double>(i) * 1e-3, std::sin(static_cast<double>(i))};
  }
  points[654'321].y = -77;
  const std::vector<Point> kept = decimated(points);
  EXPECT_LE(kept.size(), 4 * 1000U);
  EXPECT_THAT(kept, Contains(points[654'321]));
  EXPECT_EQ(kept.front(), points.front());
  EXPECT_EQ(kept.back(), points.back());
}

TEST(Decimation, AGapStaysAGap) {
  const std::vector<Point> points{{5.1, 1}, {5.2, 2}, {kNone, kNone}, {5.3, 3}, {5.4, 4}};
  const std::vector<Point> kept = decimated(points);
  ASSERT_EQ(kept.size(), 5U);
  EXPECT_TRUE(std::isnan(kept[2].x));
}

TEST(Decimation, LeavesSparsePointsAlone) {
  const std::vector<Point> points{{0, 1}, {3, 2}, {6, 1}};
  EXPECT_THAT(decimated(points), ElementsAre(points[0], points[1], points[2]));
  EXPECT_TRUE(decimated({}).empty());
}

}  // namespace
}  // namespace traverse::render
