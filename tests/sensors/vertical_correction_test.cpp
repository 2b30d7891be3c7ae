#include "traverse/sensors/vertical_correction.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace traverse::sensors {
namespace {

TEST(VerticalCorrection, RaisesElevationAndKeepsRangeAndAzimuth) {
  float x = 3;
  float y = -4;
  float z = 1;
  const double angle = 0.205 * 3.14159265358979 / 180;
  correct_elevation(&x, &y, &z, 1, angle);
  EXPECT_NEAR(std::atan2(z, std::hypot(x, y)), std::atan2(1.0, 5.0) + angle, 1e-6);
  EXPECT_NEAR(std::hypot(x, y, z), std::sqrt(26.0), 1e-5);
  EXPECT_NEAR(std::atan2(y, x), std::atan2(-4.0, 3.0), 1e-6);
}

TEST(VerticalCorrection, LeavesPointsWithoutAzimuth) {
  float x = 0;
  float y = 0;
  float z = 2;
  correct_elevation(&x, &y, &z, 1, 0.1);
  EXPECT_EQ(x, 0);
  EXPECT_EQ(z, 2);
}

}  // namespace
}  // namespace traverse::sensors
