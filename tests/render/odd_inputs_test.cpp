/// Every standard picture, with every odd input, in several sizes: nothing throws, every label can
/// be read, and it renders.
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "traverse/render/pictures/distribution.hpp"
#include "traverse/render/pictures/kitti_drift.hpp"
#include "traverse/render/pictures/map_from_above.hpp"
#include "traverse/render/pictures/scan_features.hpp"
#include "traverse/render/pictures/stage_times.hpp"
#include "traverse/render/pictures/time_series.hpp"
#include "traverse/render/pictures/trajectory_coloured.hpp"
#include "traverse/render/pictures/trajectory_from_above.hpp"
#include "traverse/render/pictures/trajectory_from_the_side.hpp"
#include "traverse/render/renderer.hpp"

#include "render/drawing_checks.hpp"
#include "render/no_number.hpp"
#include "render/sample_trajectories.hpp"

namespace traverse::render {
namespace {

constexpr float kNoFloat = std::numeric_limits<float>::quiet_NaN();

const Caption kShortCaption{"", "APE rmse 0.184 m ± 0.02, SE(3)-aligned, 108 pairs",
                            "2011_09_26_drive_0001", "floam", "2025-11-22"};
const Caption kLongCaption{
    "東京 Большая улица — a title that is much longer than any page is wide, and then some more "
    "of it",
    std::string(400, 'W'), "\xff\xfe<script>alert(1)</script>\n\t", "préset µ²", ""};

using Picture = std::function<Drawing(const Caption&, const Style&)>;

void expect_good(const Picture& picture) {
  static Renderer renderer;
  static const std::vector<Caption> captions{kShortCaption, kLongCaption, Caption{}};
  for (const auto& [width, height] :
       {std::pair{1600, 1000}, {800, 500}, {200, 150}, {1500, 300}, {300, 900}, {40, 30}}) {
    for (const Caption& caption : captions) {
      Style style;
      style.width = width;
      style.height = height;
      if (width == 800) style.theme = dark_theme();
      const Drawing drawing = picture(caption, style);
      SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height));
      expect_readable(drawing);
      if (&caption != &captions[0] || width > 800) continue;
      EXPECT_EQ(renderer.render(drawing).at(0, 0), style.theme.background);
    }
  }
}

geometry::Trajectory with_faults() {
  std::vector<geometry::Pose3> poses = square_drive(120, {0, 0, 0}).poses();
  poses[0].translation.x() = kNone;
  poses[40].translation.y() = std::numeric_limits<double>::infinity();
  poses[119].translation.z() = kNone;
  return geometry::Trajectory::unstamped(poses);
}

struct NamedCase {
  std::string name;
  geometry::Trajectory trajectory;
};

std::vector<NamedCase> trajectories() {
  geometry::Pose3 faulty;
  faulty.translation.setConstant(kNone);
  return {{"none", {}},
          {"one pose", square_drive(1, {3, 4, 5})},
          {"two poses", square_drive(2, {0, 0, 0})},
          {"all poses equal", geometry::Trajectory::unstamped(std::vector<geometry::Pose3>(50))},
          {"only faults", geometry::Trajectory::unstamped({faulty, faulty})},
          {"some faults", with_faults()},
          {"map coordinates", square_drive(200, {455'123, 5'432'100, 112})},
          {"tiny", square_drive(200, {0, 0, 0}).transformed_left(geometry::Pose3::identity())},
          {"very long", square_drive(20'000, {0, 0, 0}, 1e-4)}};
}

TEST(OddInputs, TrajectoryPictures) {
  const geometry::Trajectory reference = square_drive(150, {0, 0, 0});
  for (const NamedCase& odd : trajectories()) {
    SCOPED_TRACE(odd.name);
    for (const geometry::Trajectory* with :
         {static_cast<const geometry::Trajectory*>(nullptr), &reference}) {
      const std::vector<NamedTrajectory> estimates{{"estimate", &odd.trajectory}};
      expect_good([&](const Caption& caption, const Style& style) {
        return trajectory_from_above(estimates, with, caption, style);
      });
      expect_good([&](const Caption& caption, const Style& style) {
        return trajectory_from_the_side(estimates, with, caption, style);
      });
      std::vector<double> values(odd.trajectory.size(), 0.25);
      for (std::size_t i = 0; i < values.size(); i += 3) values[i] = i % 2 == 0 ? kNone : 1e9;
      expect_good([&](const Caption& caption, const Style& style) {
        return trajectory_coloured(odd.trajectory, {values, "APE, translation", "m"}, with, caption,
                                   style);
      });
    }
  }
}

TEST(OddInputs, ManyEstimatesWithLongNames) {
  const geometry::Trajectory one = square_drive(150, {0, 0, 0});
  const std::vector<NamedTrajectory> estimates(9, {"an estimate with a name that is long", &one});
  expect_good([&](const Caption& caption, const Style& style) {
    return trajectory_from_above(estimates, &one, caption, style);
  });
  expect_good([&](const Caption& caption, const Style& style) {
    return trajectory_from_above({}, nullptr, caption, style);
  });
}

TEST(OddInputs, Maps) {
  const geometry::Trajectory drive = square_drive(200, {455'123, 5'432'100, 112});
  const std::vector<float> many{0, 1, kNoFloat, 3, 1e30F, 5};
  const std::vector<float> equal(6, 2.5F);
  const std::vector<float> missing(6, kNoFloat);
  for (const auto& values : {std::vector<float>{}, many, equal, missing}) {
    const MapPoints points{values, values, values, {455'123, 5'432'100, 112}};
    for (const geometry::Trajectory* with :
         {static_cast<const geometry::Trajectory*>(nullptr), &drive}) {
      expect_good([&](const Caption& caption, const Style& style) {
        return map_from_above(points, {}, with, caption, style);
      });
      expect_good([&](const Caption& caption, const Style& style) {
        return map_from_above(points, {values, "intensity", "", ColourMap::kCividis}, with, caption,
                              style);
      });
    }
  }
}

TEST(OddInputs, Scans) {
  const std::vector<float> some{1, -2, 3, kNoFloat, 0, 1e20F};
  const std::vector<FeatureClass> classes{FeatureClass::kSharp,          FeatureClass::kFlat,
                                          FeatureClass::kOther,          FeatureClass::kSharp,
                                          static_cast<FeatureClass>(99), FeatureClass::kLessFlat};
  for (const ScanView view : {ScanView::kOblique, ScanView::kAbove}) {
    expect_good([&](const Caption& caption, const Style& style) {
      return scan_features({some, some, some, classes}, view, caption, style);
    });
    expect_good([&](const Caption& caption, const Style& style) {
      return scan_features({}, view, caption, style);
    });
  }
}

TEST(OddInputs, TimeSeries) {
  std::vector<double> x;
  std::vector<double> y;
  for (int i = 0; i < 30'000; ++i) {
    x.push_back(1.3e9 + 0.1 * i);
    y.push_back(i % 7000 == 0 ? 1e6 : std::sin(i));
  }
  const std::vector<double> one{5};
  const std::vector<double> nothing(x.size(), kNone);
  const std::vector<double> constant(x.size(), 4);
  const std::vector<double> extreme{-1e308, 1e308, kNone, 0, 1e-300};
  const std::vector<std::vector<Panel>> cases{
      {},
      {{"nothing at all", "", {}, {}}},
      {{"one value", "m", {{"", one, one}}, Level{5, "level"}}},
      {{"no value", "m", {{"a", x, nothing}}, Level{kNone, "none"}}},
      {{"constant", "m", {{"a", x, constant}, {"b", x, y}}, {}}},
      {{"extreme", "m", {{"", {x.data(), 5}, extreme}}, {}}},
      std::vector<Panel>(12, {"a panel with quite a long name", "deg/100 m", {{"s", x, y}}, {}})};
  for (const auto& panels : cases) {
    TimeSeries data;
    data.panels = panels;
    data.shaded = {{"skipped", {{1.3e9 + 5, 1.3e9 + 5}, {kNone, 3}, {0, 1e12}}}, {"none", {}}};
    expect_good([&](const Caption& caption, const Style& style) {
      return time_series(data, caption, style);
    });
  }
}

TEST(OddInputs, Distributions) {
  std::vector<double> long_tail(1000, 0.1);
  long_tail.back() = 1e12;
  for (const auto& values : {std::vector<double>{},
                             {kNone},
                             {0},
                             {0, 0, 0},
                             {-3, 5},
                             {1e-9, 2e-9, 3e-9},
                             {-1e308, 1e308},
                             std::vector<double>(100, 0.25),
                             long_tail}) {
    expect_good([&](const Caption& caption, const Style& style) {
      return distribution({values, "APE, translation", "m"}, caption, style);
    });
  }
}

TEST(OddInputs, StageTimesAndDrift) {
  const std::vector<StageTime> odd{
      {"a stage whose name is far too long for a column of names", 1, 2},
      {"", 0, 0},
      {"missing", kNone, kNone},
      {"percentile below median", 5, 3}};
  const std::vector<StageTime> many(40, {"stage", 1.5, 2.5});
  for (const auto& stages : {std::vector<StageTime>{}, odd, many}) {
    for (const auto& frame :
         {std::optional<StageTime>{}, std::optional(StageTime{"frame", 9, 12})}) {
      expect_good([&](const Caption& caption, const Style& style) {
        return stage_times(stages, frame, caption, style);
      });
    }
  }
  for (const auto& drift : {std::vector<DriftAtLength>{},
                            {{100, 0.6, 0.2, 1}},
                            {{100, kNone, kNone, 0}},
                            {{100, 0, 0, 3}, {200, 0, 0, 3}},
                            std::vector<DriftAtLength>(8, {100, 1e9, 1e9, 5})}) {
    expect_good([&](const Caption& caption, const Style& style) {
      return kitti_drift(drift, caption, style);
    });
  }
}

TEST(OddInputs, ArraysThatDoNotAgreeAreRefused) {
  const geometry::Trajectory drive = square_drive(3, {0, 0, 0});
  const std::vector<double> two{1, 2};
  const std::vector<float> three{1, 2, 3};
  EXPECT_THROW(trajectory_coloured(drive, {two, "", ""}, nullptr, {}, {}), std::invalid_argument);
  EXPECT_THROW(map_from_above({three, three, {}, {}}, {}, nullptr, {}, {}), std::invalid_argument);
  EXPECT_THROW(scan_features({three, three, three, {}}, ScanView::kAbove, {}, {}),
               std::invalid_argument);
  TimeSeries data;
  data.panels = {{"", "", {{"", two, {}}}, {}}};
  EXPECT_THROW(time_series(data, {}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::render
