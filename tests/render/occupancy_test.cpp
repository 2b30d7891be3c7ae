#include "plot/occupancy.hpp"

#include <gtest/gtest.h>

#include "render/no_number.hpp"

namespace traverse::render {
namespace {

TEST(Occupancy, ALineTakesThePlacesBetweenItsPoints) {
  Occupancy occupancy(200, 100);
  occupancy.add_line(std::vector<Point>{{0, 50}, {200, 50}});
  EXPECT_FALSE(occupancy.is_free({90, 40, 110, 60}));
  EXPECT_TRUE(occupancy.is_free({90, 0, 110, 40}));
}

TEST(Occupancy, AnInterruptedLineDoesNot) {
  Occupancy occupancy(200, 100);
  occupancy.add_line(std::vector<Point>{{0, 50}, {kNone, kNone}, {199, 50}});
  EXPECT_TRUE(occupancy.is_free({90, 40, 110, 60}));
}

TEST(Occupancy, PointsOutsideDoNotCount) {
  Occupancy occupancy(200, 100);
  occupancy.add({-5, 50});
  occupancy.add({1e300, 50});
  occupancy.add_line(std::vector<Point>{{1e12, 1e12}, {1e12, 2e12}});
  EXPECT_EQ(occupancy.share({0, 0, 200, 100}), 0);
}

}  // namespace
}  // namespace traverse::render
