#include "traverse/voxel_map/row_walk.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <Eigen/Core>
#include <gtest/gtest.h>

namespace traverse::voxel_map {
namespace {

/// A row of `count` points from azimuth `first` on in steps of `step` [rad], ranges by azimuth.
struct MadeRow {
  std::vector<float> x, y, z, range;

  MadeRow(int count, double first, double step, const std::function<double(double)>& range_at) {
    for (int k = 0; k < count; ++k) {
      const double azimuth = first + k * step;
      const double r = range_at(azimuth);
      x.push_back(static_cast<float>(r * std::cos(azimuth)));
      y.push_back(static_cast<float>(r * std::sin(azimuth)));
      z.push_back(0);
      range.push_back(static_cast<float>(r));
    }
  }
  Row row() const {
    return {x.data(), y.data(), z.data(), range.data(), nullptr, nullptr, 0, x.size()};
  }
  RowSamples walk(const Seam& seam = {}) const {
    std::vector<std::uint8_t> breaks;
    RowSamples samples;
    find_breaks(row(), {}, seam, breaks);
    sample_surfaces(row(), breaks, {}, 1, samples);
    sample_edges(row(), breaks, {}, 1, std::numbers::pi_v<float> / 4, samples);
    return samples;
  }
};

constexpr double kStepRad = 0.003;

/// The wall x = 20 behind a box front x = 10 that reaches from y = -1 to y = 1.
double wall_behind_box(double azimuth) {
  const bool box = std::abs(10 * std::tan(azimuth)) < 1;
  return (box ? 10 : 20) / std::cos(azimuth);
}

TEST(FindBreaks, MarksStepsAndTheSeam) {
  const MadeRow made(200, -0.3, kStepRad, wall_behind_box);
  std::vector<std::uint8_t> breaks;
  find_breaks(made.row(), {}, {}, breaks);
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    if (breaks[i] != kNoBreak) found.push_back(i);
  }
  ASSERT_EQ(found.size(), 2U);
  EXPECT_GT(made.range[found[0]], 15);
  EXPECT_LT(made.range[found[0] + 1], 12);
  EXPECT_LT(made.range[found[1]], 12);

  Seam ahead;
  ahead.by_azimuth = true;
  ahead.x = 1;
  ahead.y = 0;
  const MadeRow wall(200, -0.3005, kStepRad, [](double) { return 20.0; });
  find_breaks(wall.row(), {}, ahead, breaks);
  EXPECT_EQ(std::count(breaks.begin(), breaks.end() - 1, kSeam), 1);
  ahead.x = -1;
  find_breaks(wall.row(), {}, ahead, breaks);
  EXPECT_EQ(std::count(breaks.begin(), breaks.end() - 1, kSeam), 0) << "the seam is behind";
}

TEST(FindBreaks, RowsWithTimesBreakWhereTheTimeJumps) {
  const MadeRow made(40, 0, kStepRad, [](double) { return 20.0; });
  std::vector<float> time(40, 0.04F);
  std::fill(time.begin() + 17, time.end(), -0.05F);
  Row row = made.row();
  row.time = time.data();
  Seam seam;
  seam.time_jump_s = 0.025F;
  std::vector<std::uint8_t> breaks;
  find_breaks(row, {}, seam, breaks);
  EXPECT_EQ(breaks[16], kSeam);
  EXPECT_EQ(breaks[15], kNoBreak);
}

TEST(SampleSurfaces, KeepsPlanarPointsEverySpacing) {
  const MadeRow made(400, -0.6, kStepRad, [](double a) { return 20 / std::cos(a); });
  const RowSamples samples = made.walk();
  ASSERT_GT(samples.surface.size(), 50U);
  for (std::size_t i = 0; i < samples.surface.size(); ++i) {
    EXPECT_EQ(samples.planar[i], 1);
    EXPECT_NEAR(samples.surface.x[i], 20, 1e-4);
    if (i > 0) {
      const float gap = std::abs(samples.surface.y[i] - samples.surface.y[i - 1]);
      EXPECT_GE(gap, 0.19F);
      EXPECT_LE(gap, 0.31F);
    }
  }
  EXPECT_TRUE(samples.edges.size() == 0);
}

TEST(SampleSurfaces, AnythingRoughIsNotPlanarAndStaysWhereItIs) {
  int k = 0;
  const MadeRow made(400, -0.6, kStepRad,
                     [&](double) { return 10 + 0.2 * static_cast<double>(k++ % 3 == 0); });
  const RowSamples samples = made.walk();
  ASSERT_GT(samples.surface.size(), 20U);
  std::size_t planar = 0;
  for (const std::uint8_t flag : samples.planar) planar += flag;
  EXPECT_EQ(planar, 0U);
}

TEST(SampleEdges, AreTheEndsOfWhatStandsBeforeABackground) {
  const RowSamples samples = MadeRow(300, -0.45, kStepRad, wall_behind_box).walk();
  ASSERT_EQ(samples.edges.size(), 2U);
  // Within half a step of the true edges at y = -1 and y = 1.
  EXPECT_NEAR(samples.edges.x[0], 10, 1e-3);
  EXPECT_NEAR(samples.edges.y[0], -1, 0.5 * 10 * kStepRad);
  EXPECT_NEAR(samples.edges.y[1], 1, 0.5 * 10 * kStepRad);
}

TEST(SampleEdges, WhatIsNarrowIsOnePole) {
  const RowSamples samples = MadeRow(300, -0.45, kStepRad, [](double a) {
                               return std::abs(a - 0.1) < 0.0151 ? 8.0 : 20.0;
                             }).walk();
  ASSERT_EQ(samples.edges.size(), 1U);
  EXPECT_NEAR(std::atan2(samples.edges.y[0], samples.edges.x[0]), 0.1, kStepRad);
}

TEST(SampleEdges, TheAxisOfARoundPoleStaysWhereverItIsSeenFrom) {
  // The circle of radius 0.15 about (d, 1): the nearer root of |r u - centre| = 0.15.
  constexpr double kRadius = 0.15;
  for (const double ahead : {12.0, 6.0, 0.0, -6.0, -12.0}) {
    const Eigen::Vector2d axis(ahead, 4);
    const double towards = std::atan2(axis.y(), axis.x());
    const MadeRow made(200, towards - 0.2, 0.002, [&](double azimuth) {
      const double along = axis.dot(Eigen::Vector2d(std::cos(azimuth), std::sin(azimuth)));
      const double root = along * along - axis.squaredNorm() + kRadius * kRadius;
      return root < 0 ? 30.0 : along - std::sqrt(root);
    });
    const RowSamples samples = made.walk();
    ASSERT_EQ(samples.edges.size(), 1U);
    EXPECT_NEAR(samples.edges.x[0], axis.x(), 0.02) << "seen " << ahead << " m ahead";
    EXPECT_NEAR(samples.edges.y[0], axis.y(), 0.02);
  }
}

/// The mean of how far behind its axis a round pole is placed, metres, by ranges that scatter, over
/// all distances at which two beams can hit it.
double mean_depth_m(double radius, double step) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.02);
  std::uniform_real_distribution<double> phase(0, step);
  double sum = 0;
  double weights = 0;
  for (double distance = 4; distance < 2 * radius / step + 4; distance += 0.01) {
    const double first = phase(random) - 30 * step;
    const MadeRow made(60, first, step, [&](double azimuth) {
      const double along = distance * std::cos(azimuth);
      const double root = along * along - distance * distance + radius * radius;
      return root < 0 ? 60.0 : along - std::sqrt(root) + noise(random);
    });
    const RowSamples samples = made.walk();
    if (samples.edges.size() != 1) continue;
    sum += (samples.edges.x[0] - distance) / distance;  // as many rings hit it as it is near
    weights += 1 / distance;
  }
  return sum / weights;
}

TEST(SampleEdges, ThinPolesAreNotPlacedBehindTheirAxes) {
  // Each would seem to come along with a lidar that passes it, and so lengthen the way: of whole
  // steps from return to return by 7 to 9 mm.
  EXPECT_NEAR(mean_depth_m(0.05, 0.006), 0, 0.003);
  EXPECT_NEAR(mean_depth_m(0.1, 0.006), 0, 0.003);
  EXPECT_NEAR(mean_depth_m(0.15, 0.01), 0, 0.003);
}

TEST(SampleEdges, AWallThatRecedesAtAGrazingAngleHasNone) {
  // Along the wall y = 4 the steps grow until they pass for breaks.
  const RowSamples samples =
      MadeRow(200, 0.05, 0.007, [](double a) { return 4 / std::sin(a); }).walk();
  EXPECT_EQ(samples.edges.size(), 0U);
}

TEST(SampleEdges, TheSeamIsNoEdge) {
  Seam seam;
  seam.by_azimuth = true;
  seam.x = 1;
  // The sweep has moved on 3 m when it comes round to where it began.
  const MadeRow made(300, -0.4505, kStepRad,
                     [](double a) { return std::abs(a) > 0.2 ? 20.0 : (a < 0 ? 10.0 : 13.0); });
  EXPECT_EQ(made.walk(seam).edges.size(), 2U);
  EXPECT_EQ(made.walk().edges.size(), 3U);
}

TEST(Walk, ARowOfThreePointsGivesNothing) {
  const MadeRow made(3, 0, kStepRad, [](double) { return 20.0; });
  const RowSamples samples = made.walk();
  EXPECT_EQ(samples.surface.size(), 0U);
  EXPECT_EQ(samples.edges.size(), 0U);
}

}  // namespace
}  // namespace traverse::voxel_map
