#include "traverse/render/plot/range.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "render/no_number.hpp"

namespace traverse::render {
namespace {

TEST(Range, LeavesOutWhatIsNotFinite) {
  const std::vector<double> values{kNone, 3, -2, std::numeric_limits<double>::infinity()};
  EXPECT_EQ(Range::of(values).low, -2);
  EXPECT_EQ(Range::of(values).high, 3);
  EXPECT_EQ(Range::of(std::vector<double>{kNone}).high, 1);
}

TEST(Range, GrowsAboutItsMiddle) {
  const Range grown = Range{4, 6}.at_least(10);
  EXPECT_EQ(grown.low, 0);
  EXPECT_EQ(grown.high, 10);
  EXPECT_EQ(Range({4, 6}).at_least(1).span(), 2);
}

TEST(Percentile, InterpolatesBetweenNeighbours) {
  const std::vector<double> values{4, kNone, 1, 3, 2};
  EXPECT_EQ(percentile(values, 0), 1);
  EXPECT_EQ(percentile(values, 50), 2.5);
  EXPECT_EQ(percentile(values, 100), 4);
  EXPECT_TRUE(std::isnan(percentile(std::vector<double>{kNone}, 50)));
}

}  // namespace
}  // namespace traverse::render
