/// Pictures against stored ones, so that a change of their look is seen. After an intended change:
/// TRAVERSE_WRITE_REFERENCES=1 render_test --gtest_filter='ReferenceImages.*', and look at them.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "traverse/geometry/trajectory.hpp"
#include "traverse/render/pictures/map_from_above.hpp"
#include "traverse/render/pictures/map_in_perspective.hpp"
#include "traverse/render/pictures/scan_matches.hpp"
#include "traverse/render/pictures/time_series.hpp"
#include "traverse/render/pictures/violins.hpp"
#include "traverse/render/renderer.hpp"

namespace traverse::render {
namespace {

/// Other versions of the software renderer and of the font library move edges a little, everywhere.
/// A word that is missing or changed is a difference in few blocks, but there a large one.
constexpr int kClearlyDifferent = 48;  // of 255
constexpr int kBlock = 16;             // pixels, about the height of a letter
constexpr int kMostInBlock = 24;       // pixels of 256 that may differ clearly

Style small(bool dark = false) {
  Style style;
  style.width = 640;
  style.height = 400;
  if (dark) style.theme = dark_theme();
  return style;
}

/// Where a block of pixels differs from the stored one, and by how many of them; empty if none.
std::string worst_block(const cv::Mat& difference) {
  int most = kMostInBlock;
  std::string text;
  for (int y = 0; y < difference.rows; y += kBlock) {
    for (int x = 0; x < difference.cols; x += kBlock) {
      const cv::Rect block(x, y, std::min(kBlock, difference.cols - x),
                           std::min(kBlock, difference.rows - y));
      const int different = cv::countNonZero(difference(block) > kClearlyDifferent);
      if (different <= most) continue;
      most = different;
      text = std::to_string(different) + " pixels differ in the block at " + std::to_string(x) +
             ", " + std::to_string(y);
    }
  }
  return text;
}

void compare_with_reference(const Drawing& drawing, const std::string& name) {
  const Image image = Renderer().render(drawing);
  const std::filesystem::path file =
      std::filesystem::path(TRAVERSE_SOURCE_DIR) / "tests/render/references" / (name + ".png");
  if (std::getenv("TRAVERSE_WRITE_REFERENCES") != nullptr) image.write_png(file);
  cv::Mat stored = cv::imread(file.string(), cv::IMREAD_COLOR);
  ASSERT_FALSE(stored.empty()) << file;
  ASSERT_EQ(stored.size(), cv::Size(image.width, image.height));
  cv::Mat drawn;
  cv::cvtColor(
      cv::Mat(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data())),
      drawn, cv::COLOR_RGB2BGR);
  cv::Mat difference;
  cv::absdiff(drawn, stored, difference);
  std::vector<cv::Mat> channels;
  cv::split(difference, channels);
  const cv::Mat largest = cv::max(cv::max(channels[0], channels[1]), channels[2]);
  EXPECT_EQ(worst_block(largest), "") << file;
}

/// A street with a bend: ground, facades and poles.
struct Street {
  std::vector<float> x, y, z;
  geometry::Trajectory way;

  Street() {
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<geometry::Pose3> poses(60);
    const auto bend = [](double along) { return 0.004 * along * along; };
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const auto along = 2.0 * static_cast<double>(i);
      poses[i].translation = {along, bend(along), 1.7};
    }
    way = geometry::Trajectory::unstamped(poses);
    for (int i = 0; i < 30'000; ++i) {
      const double along = 120 * uniform(generator);
      const bool facade = i % 3 == 0;
      const double across = facade ? (i % 2 == 0 ? 10.0 : -10.0) : 20 * (uniform(generator) - 0.5);
      x.push_back(static_cast<float>(along));
      y.push_back(static_cast<float>(bend(along) + across));
      z.push_back(static_cast<float>(facade ? 8 * uniform(generator) : 0.0));
    }
  }
  MapPoints points() const { return {x, y, z, Eigen::Vector3d::Zero()}; }
};

const Caption kReferenceCaption{"A reference picture", "made by a test", "street", "none",
                                "2026-01-02"};

TEST(ReferenceImages, MapFromAbove) {
  const Street street;
  compare_with_reference(
      map_from_above(street.points(), {}, &street.way, kReferenceCaption, small()),
      "map-from-above");
}

/// The comparison sees each word of a picture, not only its large shapes.
TEST(ReferenceImages, AMissingWordIsSeen) {
  const Street street;
  const auto drawn = [&](const Caption& caption) {
    const Image image =
        Renderer().render(map_from_above(street.points(), {}, &street.way, caption, small()));
    return cv::Mat(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data()))
        .clone();
  };
  const cv::Mat whole = drawn(kReferenceCaption);
  for (std::string Caption::*word : {&Caption::title, &Caption::statistic, &Caption::recording}) {
    Caption without = kReferenceCaption;
    (without.*word).clear();
    cv::Mat difference;
    cv::absdiff(whole, drawn(without), difference);
    std::vector<cv::Mat> channels;
    cv::split(difference, channels);
    EXPECT_NE(worst_block(cv::max(cv::max(channels[0], channels[1]), channels[2])), "")
        << kReferenceCaption.*word;
  }
}

TEST(ReferenceImages, MapInPerspective) {
  const Street street;
  compare_with_reference(
      map_in_perspective(street.points(), {}, street.way, kReferenceCaption, small(true)),
      "map-in-perspective");
}

TEST(ReferenceImages, MapWithNorth) {
  const Street street;
  compare_with_reference(map_from_above(street.points(), {}, &street.way, kReferenceCaption,
                                        small(true), Eigen::Vector3d(-0.5, 1, 0)),
                         "map-with-north");
}

TEST(ReferenceImages, ScanMatches) {
  const Street street;
  struct Kind {
    std::vector<float> x, y, z, pulled, none;
    Matches matches() const { return {{x, y, z, Eigen::Vector3d::Zero()}, none, pulled, none}; }
  };
  Kind on_lines, on_planes;
  for (std::size_t i = 0; i < street.x.size(); i += 20) {
    Kind& kind = i % 100 == 0 ? on_lines : on_planes;
    kind.x.push_back(street.x[i]);
    kind.y.push_back(street.y[i]);
    kind.z.push_back(street.z[i]);
    kind.pulled.push_back(0.1F + 0.05F * std::sin(street.x[i]));  // to the left: the pose is off
    kind.none.push_back(0);
  }
  compare_with_reference(scan_matches({street.points(), on_lines.matches(), on_planes.matches()},
                                      street.way, kReferenceCaption, small()),
                         "scan-matches");
}

TEST(ReferenceImages, TimeSeriesAndViolins) {
  std::vector<double> times;
  std::vector<double> values;
  for (int i = 0; i < 200; ++i) {
    times.push_back(0.1 * i);
    values.push_back(0.05 + 0.04 * std::sin(0.3 * i) + 0.0002 * i);
  }
  TimeSeries series;
  series.panels.push_back({"error", "m", {{"", times, values}}, Level{0.07, "rmse 0.07 m"}});
  compare_with_reference(time_series(series, kReferenceCaption, small()), "time-series");
  const std::vector<Sampled> sampled{{values, "error", "m"}, {times, "time", "s"}};
  compare_with_reference(violins(sampled, kReferenceCaption, small(true)), "violins");
}

TEST(Violins, TellsWhereThereIsNothing) {
  EXPECT_NO_THROW(violins({}, kReferenceCaption, small()));
  const std::vector<double> none;
  const std::vector<double> same(30, 2.0);
  const std::vector<Sampled> sampled{{none, "nothing", "m"}, {same, "constant", "m"}};
  EXPECT_NO_THROW(violins(sampled, kReferenceCaption, small()));
}

TEST(MapInPerspective, StandsWithoutPointsAndWithoutAWay) {
  EXPECT_NO_THROW(map_in_perspective({}, {}, geometry::Trajectory::unstamped({}), {}, small()));
  const std::vector<float> one{1};
  const std::vector<float> none;
  EXPECT_THROW(map_in_perspective({one, none, one, Eigen::Vector3d::Zero()}, {},
                                  geometry::Trajectory::unstamped({}), {}, small()),
               std::invalid_argument);
}

}  // namespace
}  // namespace traverse::render
