/// What the standard pictures show of usual data.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/render/palette.hpp"
#include "traverse/render/pictures/distribution.hpp"
#include "traverse/render/pictures/kitti_drift.hpp"
#include "traverse/render/pictures/map_from_above.hpp"
#include "traverse/render/pictures/scan_features.hpp"
#include "traverse/render/pictures/scan_matches.hpp"
#include "traverse/render/pictures/stage_times.hpp"
#include "traverse/render/pictures/time_series.hpp"
#include "traverse/render/pictures/trajectory_coloured.hpp"
#include "traverse/render/pictures/trajectory_from_above.hpp"
#include "traverse/render/pictures/trajectory_from_the_side.hpp"
#include "traverse/render/renderer.hpp"

#include "render/drawing_checks.hpp"
#include "render/sample_trajectories.hpp"

namespace traverse::render {
namespace {

using ::testing::Contains;

const Caption kCaption{"", "APE rmse 0.184 m, SE(3)-aligned, 108 pairs", "drive_0001", "floam",
                       "2025-11-22"};

TEST(Pictures, StandAlone) {
  const geometry::Trajectory drive = square_drive(200, {0, 0, 0});
  const std::vector<NamedTrajectory> estimates{{"estimate", &drive}};
  const Drawing drawing = trajectory_from_above(estimates, nullptr, kCaption, {});
  EXPECT_TRUE(says(drawing, "Trajectory from above"));
  EXPECT_TRUE(says(drawing, "drive_0001  ·  floam  ·  2025-11-22"));
  EXPECT_TRUE(says(drawing, "APE rmse 0.184 m, SE(3)-aligned, 108 pairs"));
  EXPECT_TRUE(says(drawing, "x [m]"));
  EXPECT_TRUE(says(drawing, "y [m]"));
  EXPECT_TRUE(says(drawing, "every 10 % of the path"));
}

TEST(TrajectoryFromAbove, HasEqualScaleAndTheReferenceDashedOnTop) {
  const geometry::Trajectory drive = square_drive(200, {0, 0, 0});  // a square of 50 m
  const std::vector<NamedTrajectory> estimates{{"estimate", &drive}};
  const Drawing drawing = trajectory_from_above(estimates, &drive, kCaption, {});
  const Polyline& estimate = data_line(drawing, palette::series(0));
  ASSERT_EQ(estimate.points.size(), drive.size());
  const Point corner = estimate.points[0];
  EXPECT_NEAR(estimate.points[50].x - corner.x, corner.y - estimate.points[150].y, 1e-6);
  EXPECT_GT(estimate.points[50].x, corner.x);   // x to the right
  EXPECT_LT(estimate.points[100].y, corner.y);  // y up

  const Polyline& reference = data_line(drawing, light_theme().reference);
  ASSERT_EQ(reference.points.size(), drive.size());
  EXPECT_FALSE(reference.dashes.empty());
  EXPECT_LT(reference.width, estimate.width);
}

TEST(TrajectoryFromAbove, ALegendOfManyRowsPushesThePlotDown) {
  const geometry::Trajectory drive = square_drive(200, {0, 0, 0});
  std::vector<NamedTrajectory> estimates;
  estimates.reserve(12);
  for (int i = 0; i < 12; ++i) estimates.push_back({"estimate " + std::to_string(i), &drive});
  Style style;
  style.width = 800;
  style.height = 500;
  const Drawing drawing = trajectory_from_above(estimates, nullptr, kCaption, style);
  double lowest = 0;
  for (int i = 0; i < 12; ++i) {
    EXPECT_THAT(texts_of(drawing), Contains("estimate " + std::to_string(i)));
  }
  for (const Text& text : drawing.texts) {
    if (text.utf8.starts_with("estimate ")) lowest = std::max(lowest, text.anchor.y);
  }
  for (const Drawing::Item& item : drawing.items) {
    if (item.clip) {
      EXPECT_GT(item.clip->top, lowest);
    }
  }
}

TEST(TrajectoryFromAbove, KeepsTheDetailOfLargeCoordinates) {
  const geometry::Trajectory near = square_drive(200, {0, 0, 0});
  const geometry::Trajectory far = square_drive(200, {4e6, 5e6, 0});
  const std::vector<NamedTrajectory> near_estimates{{"estimate", &near}};
  const std::vector<NamedTrajectory> far_estimates{{"estimate", &far}};
  const Drawing a = trajectory_from_above(near_estimates, nullptr, kCaption, {});
  const Drawing b = trajectory_from_above(far_estimates, nullptr, kCaption, {});
  const auto& line_a = data_line(a, palette::series(0));
  const auto& line_b = data_line(b, palette::series(0));
  ASSERT_EQ(line_a.points.size(), line_b.points.size());
  for (std::size_t i = 0; i < line_a.points.size(); ++i) {
    const Point step_a = line_a.points[i] - line_a.points[0];
    const Point step_b = line_b.points[i] - line_b.points[0];
    EXPECT_NEAR(step_a.x, step_b.x, 0.02 * std::abs(step_a.x) + 0.01);
    EXPECT_NEAR(step_a.y, step_b.y, 0.02 * std::abs(step_a.y) + 0.01);
  }
  EXPECT_TRUE(says(b, "x − 4\u2009000\u2009000 [m]") || says(b, "x − 3\u2009999"));
}

TEST(TrajectoryFromAbove, AGapInTimeIsAGapInTheLine) {
  geometry::Trajectory drive = square_drive(100, {0, 0, 0});
  geometry::Pose3 later = drive.pose(99);
  later.translation.x() += 20;
  drive.push_back(geometry::shifted(drive.stamp(99), 10), later);
  drive.push_back(geometry::shifted(drive.stamp(99), 10.1), later);
  const std::vector<NamedTrajectory> estimates{{"estimate", &drive}};
  const Drawing drawing = trajectory_from_above(estimates, nullptr, kCaption, {});
  const Polyline& line = data_line(drawing, palette::series(0));
  ASSERT_EQ(line.points.size(), 103U);
  EXPECT_TRUE(std::isnan(line.points[100].x));
}

TEST(TrajectoryFromTheSide, StatesTheExaggeration) {
  const geometry::Trajectory drive = square_drive(200, {0, 0, 0});
  const std::vector<NamedTrajectory> estimates{{"estimate", &drive}};
  const Drawing drawing = trajectory_from_the_side(estimates, &drive, kCaption, {});
  EXPECT_TRUE(says(drawing, "heights exaggerated"));
  EXPECT_TRUE(says(drawing, "distance travelled [m]"));
  EXPECT_TRUE(says(drawing, "height z [m]"));
}

TEST(TrajectoryColoured, MarksTheWorstPoseAndSaysWhereItsColoursEnd) {
  const geometry::Trajectory drive = square_drive(200, {0, 0, 0});
  std::vector<double> errors(200);
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] = 0.001 * static_cast<double>(i);
  errors[77] = 4.25;
  const Drawing drawing = trajectory_coloured(drive, {errors, "APE", "m"}, &drive, kCaption, {});
  EXPECT_TRUE(says(drawing, "max 4.25 m"));
  EXPECT_TRUE(says(drawing, "percentile"));
  EXPECT_TRUE(says(drawing, "APE [m]"));
  const auto lines = all_of_kind<Polyline>(drawing);
  const auto coloured = std::find_if(lines.begin(), lines.end(),
                                     [](const Polyline* line) { return !line->colours.empty(); });
  ASSERT_NE(coloured, lines.end());
  EXPECT_EQ((*coloured)->colours.at(77), colour_at(ColourMap::kViridis, 1));
  EXPECT_EQ((*coloured)->colours.at(0), colour_at(ColourMap::kViridis, 0));
}

TEST(MapFromAbove, LeavesOutFaultsAndIsNotShrunkByStrayPoints) {
  std::vector<float> x;
  std::vector<float> y;
  std::vector<float> z;
  for (int i = 0; i < 10'000; ++i) {
    x.push_back(static_cast<float>(i % 100));
    y.push_back(std::floor(static_cast<float>(i) / 100));
    z.push_back(static_cast<float>(i % 7));
  }
  x[0] = 1e6F;
  y[1] = std::numeric_limits<float>::quiet_NaN();
  const Drawing drawing = map_from_above({x, y, z, {1e6, 2e6, 50}}, {}, nullptr, kCaption, {});
  const auto clouds = all_of_kind<PointCloud>(drawing);
  ASSERT_EQ(clouds.size(), 1U);
  EXPECT_EQ(clouds[0]->points.size(), x.size() - 1);
  EXPECT_LT(clouds[0]->camera.half_height, 60);
  EXPECT_LT(std::abs(clouds[0]->points[5000].x), 100);  // near the scene's origin
  EXPECT_TRUE(says(drawing, "10\u2009000 points"));
  EXPECT_TRUE(says(drawing, "height z [m]"));
  EXPECT_TRUE(says(drawing, "52"));  // heights are those of the map
}

TEST(MapFromAbove, AnArrowPointsToNorthWhereItIsKnown) {
  const geometry::Trajectory drive = square_drive(200, {0, 0, 0});
  const std::vector<float> x{0, 50};
  const MapPoints points{x, x, x, Eigen::Vector3d::Zero()};
  EXPECT_FALSE(says(map_from_above(points, {}, &drive, kCaption, {}), "N"));
  for (const double angle : {0.3, 2.0, -1.2}) {
    const Eigen::Vector3d north(std::cos(angle), std::sin(angle), 0.2);
    const Drawing drawing = map_from_above(points, {}, &drive, kCaption, {}, north);
    const auto letter = std::find_if(drawing.texts.begin(), drawing.texts.end(),
                                     [](const Text& text) { return text.utf8 == "N"; });
    ASSERT_NE(letter, drawing.texts.end());
    const auto halves = all_of_kind<Polygon>(drawing);
    const Point tip = halves.back()->corners.at(0);
    const Point notch = halves.back()->corners.at(2);
    EXPECT_NEAR(std::atan2(notch.y - tip.y, tip.x - notch.x), angle, 1e-9);
    expect_readable(drawing);
  }
  EXPECT_FALSE(
      says(map_from_above(points, {}, &drive, kCaption, {}, Eigen::Vector3d(0, 0, 1)), "N"))
      << "seen along north";
}

TEST(ScanMatches, ResidualsAreLinesOfTheStatedLength) {
  const geometry::Trajectory drive = square_drive(20, {0, 0, 0});
  std::vector<float> x;
  std::vector<float> offset(200, 0.05F);
  for (int i = 0; i < 200; ++i) x.push_back(0.1F * static_cast<float>(i));
  const std::vector<float> none(200, 0);
  const MapPoints points{x, x, none, Eigen::Vector3d::Zero()};
  const std::span<const float> few = std::span(x).first(30);
  const Matches on_planes{points, offset, none, none};
  const Matches on_lines{{few, few, std::span(none).first(30), Eigen::Vector3d::Zero()},
                         std::span(none).first(30),
                         std::span(offset).first(30),
                         std::span(none).first(30)};
  const Drawing drawing = scan_matches({points, on_lines, on_planes}, drive, kCaption, {});
  const auto lines = all_of_kind<Polyline>(drawing);
  const auto of_length = [&](std::size_t points_of_line) {
    return std::find_if(lines.begin(), lines.end(), [&](const Polyline* line) {
      return line->points.size() == points_of_line;
    });
  };
  const auto residuals = of_length(600);
  ASSERT_NE(residuals, lines.end());
  ASSERT_NE(of_length(90), lines.end());
  EXPECT_NE((*residuals)->colour, (*of_length(90))->colour);
  const auto& at = (*residuals)->points;
  const double pixels_a_metre = (at[3].x - at[0].x) / 0.1;
  const double times = (at[1].x - at[0].x) / (0.05 * pixels_a_metre);
  EXPECT_NEAR(times, std::round(times), 1e-3);
  EXPECT_TRUE(says(drawing, "residual, " + std::to_string(std::lround(times)) + " times as long"));
  EXPECT_TRUE(says(drawing, "200 on planes"));
  EXPECT_TRUE(says(drawing, "30 on lines"));
  expect_readable(drawing);

  EXPECT_TRUE(says(scan_matches({points, {}, {}}, drive, kCaption, {}), "did not keep"));
  EXPECT_NO_THROW(scan_matches({}, geometry::Trajectory::unstamped({}), {}, {}));
  EXPECT_THROW(scan_matches({points, {points, offset, none, {}}, {}}, drive, kCaption, {}),
               std::invalid_argument);
}

TEST(ScanFeatures, CountsEachClassAndDrawsTheSharpestLast) {
  const std::vector<float> x{5, 6, 7, 8, 9, 10};
  const std::vector<FeatureClass> classes{FeatureClass::kSharp,     FeatureClass::kSharp,
                                          FeatureClass::kLessSharp, FeatureClass::kFlat,
                                          FeatureClass::kLessFlat,  FeatureClass::kOther};
  const Drawing drawing = scan_features({x, x, x, classes}, ScanView::kAbove, kCaption, {});
  EXPECT_THAT(texts_of(drawing), Contains("sharp  2"));
  EXPECT_THAT(texts_of(drawing), Contains("other  1"));
  EXPECT_THAT(texts_of(drawing), Contains("10 m"));
  const auto clouds = all_of_kind<PointCloud>(drawing);
  ASSERT_EQ(clouds.size(), 5U);
  EXPECT_EQ(clouds.front()->points.at(0).colour, light_theme().other);
  EXPECT_EQ(clouds.back()->points.at(0).colour, palette::kSharp);
}

TEST(TimeSeriesPicture, GapsAreGapsAndPeaksSurvive) {
  std::vector<double> x;
  std::vector<double> y;
  for (int i = 0; i < 200'000; ++i) {
    x.push_back(i < 100'000 ? 0.1 * i : 0.1 * i + 500);
    y.push_back(i == 123'456 ? 9 : 1);
  }
  TimeSeries data;
  data.panels = {{"APE", "m", {{"", x, y}}, Level{1, "median 1 m"}}};
  const Drawing drawing = time_series(data, kCaption, {});
  const auto lines = lines_of(drawing, palette::series(0));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_LT(lines[0]->points.size(), 4 * 1600U);
  int gaps = 0;
  double highest = 1e9;
  double lowest = 0;
  for (const Point& p : lines[0]->points) {
    if (std::isnan(p.x)) {
      ++gaps;
    } else {
      highest = std::min(highest, p.y);
      lowest = std::max(lowest, p.y);
    }
  }
  EXPECT_EQ(gaps, 1);
  EXPECT_GT(lowest - highest, 500);  // the peak of a single sample
  EXPECT_TRUE(says(drawing, "median 1 m"));
}

TEST(TimeSeriesPicture, ASingleSkippedFrameCanBeSeen) {
  std::vector<double> x(10'000);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<double>(i);
  TimeSeries data;
  data.panels = {{"APE", "m", {{"", x, x}}, {}}};
  data.shaded = {{"skipped frames", {{5000, 5001}}}};
  const Drawing drawing = time_series(data, kCaption, {});
  const auto polygons = all_of_kind<Polygon>(drawing);
  ASSERT_EQ(polygons.size(), 2U);  // in the legend and in the panel
  EXPECT_GE(polygons[1]->corners[1].x - polygons[1]->corners[0].x, 2);
  EXPECT_TRUE(says(drawing, "skipped frames"));
}

TEST(Distribution, MarksMedianAnd95PercentAndSaysWhatItCutsOff) {
  std::vector<double> values;
  for (int i = 1; i <= 1000; ++i) values.push_back(0.001 * i);
  values.push_back(50);
  const Drawing drawing = distribution({values, "APE", "m"}, kCaption, {});
  EXPECT_TRUE(says(drawing, "median 0.501 m"));
  EXPECT_TRUE(says(drawing, "95 % below 0.951 m"));
  EXPECT_TRUE(says(drawing, "not shown, largest 50.0 m"));
}

TEST(StageTimes, BarsEndAtTheMedian) {
  const std::vector<StageTime> stages{{"features", 2, 3}, {"solve", 4, 5}};
  const Drawing drawing = stage_times(stages, StageTime{"whole frame", 8, 10}, kCaption, {});
  const auto bars = all_of_kind<Polygon>(drawing);
  ASSERT_EQ(bars.size(), 3U);
  const auto length = [&](std::size_t i) { return bars[i]->corners[1].x - bars[i]->corners[0].x; };
  EXPECT_NEAR(length(1), 2 * length(0), 1e-6);
  EXPECT_NEAR(length(2), 4 * length(0), 1e-6);
  EXPECT_THAT(texts_of(drawing), Contains("8.00"));
}

TEST(KittiDrift, WeighsTheMeanByTheSegments) {
  const std::vector<DriftAtLength> drift{{100, 1.0, 0.5, 30}, {200, 2.0, 0.2, 10}};
  const Drawing drawing = kitti_drift(drift, kCaption, {});
  EXPECT_TRUE(says(drawing, "mean of all segments 1.25 %"));
  EXPECT_THAT(texts_of(drawing), Contains("n = 30"));
  EXPECT_TRUE(says(kitti_drift({}, kCaption, {}), "not defined"));
}

}  // namespace
}  // namespace traverse::render
