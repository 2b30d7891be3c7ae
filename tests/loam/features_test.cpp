#include "traverse/loam/features.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "curvature.hpp"
#include "loam/made_lines.hpp"

namespace traverse::loam {
namespace {

constexpr double kSpacing = 0.004;  // rad between points of a line

bool is_edge(lidar::FeatureClass c) {
  return c == lidar::FeatureClass::kSharp || c == lidar::FeatureClass::kLessSharp;
}

/// A line of 201 points that looks along +x at a corner of two walls in its middle.
lidar::ScanLines corner() {
  lidar::ScanLines lines;
  testing::add_line(lines, 201, -100 * kSpacing, kSpacing, [](double azimuth) {
    return 10 / (std::cos(azimuth) + std::abs(std::sin(azimuth)));
  });
  return lines;
}

TEST(Features, ACornerIsSharpAndTheWallsAreFlat) {
  FeatureOptions options;
  options.sectors = 1;
  const Features features = extract_features(corner(), options);
  EXPECT_EQ(features.classes[100], lidar::FeatureClass::kSharp);
  EXPECT_EQ(features.count(lidar::FeatureClass::kFlat), 4U);
  EXPECT_GT(features.count(lidar::FeatureClass::kLessFlat), 150U);
  for (std::size_t i = 0; i < 201; ++i) {
    if (is_edge(features.classes[i])) {
      EXPECT_LE(std::abs(static_cast<int>(i) - 100), 6) << i;
    }
  }
}

TEST(Features, PickedPointsKeepTheirDistance) {
  FeatureOptions options;
  options.edge_curvature = 0;
  options.planar_curvature = 0;
  options.noise_m = 0;
  const Features features = extract_features(corner(), options);
  int last = -100;
  for (int i = 0; i < 201; ++i) {
    if (!is_edge(features.classes[static_cast<std::size_t>(i)])) continue;
    EXPECT_GT(i - last, 5);
    last = i;
  }
  EXPECT_GT(features.count(lidar::FeatureClass::kLessSharp), 10U);
}

TEST(Features, EverySectorCoversItsPointsToTheLast) {
  // On a circle every point is planar; whatever the number of sectors, none with a curvature may
  // be forgotten (published codes lose the last point of each sector).
  lidar::ScanLines lines;
  testing::add_line(lines, 127, 0, kSpacing, [](double) { return 10.0; });
  for (const int sectors : {1, 2, 5, 6, 7}) {
    FeatureOptions options;
    options.sectors = sectors;
    const Features features = extract_features(lines, options);
    EXPECT_EQ(
        features.count(lidar::FeatureClass::kFlat) + features.count(lidar::FeatureClass::kLessFlat),
        127 - 2 * kCurvatureReach)
        << sectors;
  }
}

/// A pole (near) before a wall (far): points 90..110 at 5 m, the rest at 10 m.
lidar::ScanLines pole_before_wall() {
  lidar::ScanLines lines;
  testing::add_line(lines, 201, -100 * kSpacing, kSpacing, [](double azimuth) {
    return std::abs(azimuth) < 10.5 * kSpacing ? 5.0 : 10.0;
  });
  return lines;
}

TEST(Features, TheNearSideOfADepthJumpIsAnEdgeTheFarSideIsNot) {
  const Features features = extract_features(pole_before_wall(), FeatureOptions{});
  EXPECT_TRUE(is_edge(features.classes[90]));
  EXPECT_TRUE(is_edge(features.classes[110]));
  for (const std::size_t far_side : {84U, 85U, 86U, 87U, 88U, 89U, 111U, 112U, 113U, 114U, 115U}) {
    EXPECT_EQ(features.classes[far_side], lidar::FeatureClass::kNone) << far_side;
  }
}

TEST(Features, AGrazedSurfaceGivesNoFeature) {
  // A wall along the beam: y = 0.5 seen from far along x; steps are long against the range.
  lidar::ScanLines lines;
  testing::add_line(lines, 60, 0.005, 0.0005,
                    [](double azimuth) { return 0.5 / std::sin(azimuth); });
  FeatureOptions options;
  options.break_m = 100;  // no depth jumps: only the grazing rule is under test
  const Features features = extract_features(lines, options);
  for (std::size_t i = 5; i < 15; ++i)
    EXPECT_EQ(features.classes[i], lidar::FeatureClass::kNone) << i;
}

TEST(Features, ShortAndEmptyLinesHaveNone) {
  lidar::ScanLines lines;
  testing::add_line(lines, 10, 0, kSpacing, [](double) { return 10.0; });
  EXPECT_EQ(extract_features(lines, FeatureOptions{}).count(lidar::FeatureClass::kNone), 10U);
  EXPECT_TRUE(extract_features(lidar::ScanLines{}, FeatureOptions{}).classes.empty());
}

}  // namespace
}  // namespace traverse::loam
