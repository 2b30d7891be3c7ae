#include "traverse/evaluation/worst_segments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace traverse::evaluation {
namespace {

/// A bend; after a pose it goes on beside itself.
geometry::Trajectory bend(std::size_t poses, double jump_after, double jump_m) {
  geometry::Trajectory way;
  for (std::size_t i = 0; i < poses; ++i) {
    const auto k = static_cast<double>(i);
    geometry::Pose3 pose;
    pose.translation = {k, 0.01 * k * k, k > jump_after ? jump_m : 0};
    way.push_back(geometry::Stamp::from_seconds(0.1 * k), pose);
  }
  return way;
}

TEST(WorstSegments, AreTheLargestRelativeErrorsAndDoNotOverlap) {
  const Evaluation evaluation =
      evaluate(bend(100, 40, 0.5), bend(100, 1000, 0), run_evaluation_options());
  const WorstSegments worst = worst_segments(evaluation, {});
  EXPECT_EQ(worst.measure, "RPE over 10 frames");
  ASSERT_EQ(worst.segments.size(), 5U);
  EXPECT_LE(worst.segments[0].first, 40U);
  EXPECT_GT(worst.segments[0].last, 40U);
  EXPECT_NEAR(worst.segments[0].value, 0.5, 0.02);
  for (std::size_t a = 0; a < worst.segments.size(); ++a) {
    EXPECT_EQ(worst.segments[a].last - worst.segments[a].first, 10U);
    for (std::size_t b = 0; b < a; ++b) {
      EXPECT_GE(worst.segments[b].value, worst.segments[a].value);
      EXPECT_TRUE(worst.segments[a].last < worst.segments[b].first ||
                  worst.segments[b].last < worst.segments[a].first);
    }
  }
}

/// One pose of the reference is a metre off, and elsewhere the estimate drifts by 0.4 m in ten
/// frames: the first makes the largest relative errors, the second the worst stretch.
TEST(WorstSegments, AreNotMadeByOnePoseThatJitters) {
  geometry::Trajectory reference;
  geometry::Trajectory estimate;
  for (std::size_t i = 0; i < 200; ++i) {
    const auto k = static_cast<double>(i);
    geometry::Pose3 pose;
    pose.translation = {k, 0.01 * k * k, i == 60 ? 1.0 : 0};
    reference.push_back(geometry::Stamp::from_seconds(0.1 * k), pose);
    pose.translation.z() = i < 140 ? 0 : 0.04 * std::min(10.0, k - 140);
    estimate.push_back(geometry::Stamp::from_seconds(0.1 * k), pose);
  }
  const WorstSegments worst =
      worst_segments(evaluate(estimate, reference, run_evaluation_options()), {});
  EXPECT_GE(worst.segments[0].last, 140U);
  EXPECT_NEAR(worst.segments[0].value, 0.4, 0.1);
}

TEST(WorstSegments, WithoutAReferenceResidualsTell) {
  std::vector<double> residual(60, 0.01);
  for (std::size_t i = 31; i <= 40; ++i) residual[i] = 0.2;
  residual[5] = std::numeric_limits<double>::quiet_NaN();
  const WorstSegments worst = worst_segments(evaluate(bend(60, 1000, 0)), residual);
  EXPECT_EQ(worst.measure, "residual rms over 10 frames");
  ASSERT_FALSE(worst.segments.empty());
  EXPECT_EQ(worst.segments[0].first, 30U);
  EXPECT_EQ(worst.segments[0].last, 40U);
  EXPECT_NEAR(worst.segments[0].value, 0.2, 1e-12);
  for (const WorstSegment& segment : worst.segments) EXPECT_TRUE(std::isfinite(segment.value));
}

TEST(WorstSegments, AShortRunHasNone) {
  EXPECT_TRUE(worst_segments(evaluate(bend(8, 1000, 0)), {}).segments.empty());
  EXPECT_TRUE(
      worst_segments(evaluate(bend(8, 1000, 0)), std::vector<double>(8, 1)).segments.empty());
}

}  // namespace
}  // namespace traverse::evaluation
