#include "curvature.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "loam/made_lines.hpp"

namespace traverse::loam {
namespace {

/// One line of points on the x axis at the given places, y = 1 so that no range is zero.
lidar::ScanLines line_at(const std::vector<float>& x) {
  lidar::ScanLines lines;
  for (const float value : x) {
    lines.x.push_back(value);
    lines.y.push_back(1);
    lines.z.push_back(0);
    lines.range.push_back(std::hypot(value, 1.0F));
  }
  lines.line_begin.push_back(static_cast<std::uint32_t>(x.size()));
  return lines;
}

TEST(Curvature, IsTheFormulaOfLoam) {
  // Neighbours at -5 .. 5 but the last at 8: the sum of differences is 3, ten neighbours, range 1.
  const auto c = curvature(line_at({-5, -4, -3, -2, -1, 0, 1, 2, 3, 4, 8}));
  EXPECT_FLOAT_EQ(c[5], 3.0F / 10.0F);
}

TEST(Curvature, EvenlySpacedPointsHaveNone) {
  const auto c = curvature(line_at({-5, -4, -3, -2, -1, 0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(c[5], 0);
}

TEST(Curvature, IsDividedByTheRange) {
  const auto wall_at = [](double distance) {
    lidar::ScanLines lines;  // a right-angled corner
    testing::add_line(lines, 11, -0.05, 0.01, [&](double azimuth) {
      return distance / (std::cos(azimuth) + std::abs(std::sin(azimuth)));
    });
    return curvature(lines)[5];
  };
  EXPECT_NEAR(wall_at(20) / wall_at(10), 1, 1e-4);
}

TEST(Curvature, NeverLooksAcrossTheEndOfALine) {
  lidar::ScanLines lines;
  testing::add_line(lines, 11, 0, 0.01, [](double) { return 10.0; });
  testing::add_line(lines, 10, 0, 0.01, [](double) { return 50.0; });
  const auto c = curvature(lines);
  for (std::size_t i = 0; i < c.size(); ++i) {
    EXPECT_EQ(std::isnan(c[i]), i != 5) << i;  // the second line is too short for any
  }
  EXPECT_LT(c[5], 0.001F);
}

}  // namespace
}  // namespace traverse::loam
