#include "traverse/render/renderer.hpp"

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "render/no_number.hpp"
#include "render/sample_drawing.hpp"

namespace traverse::render {
namespace {

constexpr Colour kWhite{255, 255, 255};
constexpr Colour kRed{255, 0, 0};
constexpr Colour kBlue{0, 0, 255};

Drawing empty_drawing(int width, int height) {
  Drawing drawing;
  drawing.width = width;
  drawing.height = height;
  drawing.background = kWhite;
  return drawing;
}

Polyline line(std::vector<Point> points, double width, LineCap cap = LineCap::kButt) {
  Polyline polyline;
  polyline.points = std::move(points);
  polyline.colour = kRed;
  polyline.width = width;
  polyline.cap = cap;
  return polyline;
}

/// Share of the pixel that is red instead of white.
double redness(const Image& image, int x, int y) { return (255 - image.at(x, y).green) / 255.0; }

double total_redness(const Image& image) {
  double sum = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) sum += redness(image, x, y);
  }
  return sum;
}

TEST(Renderer, AnEmptyDrawingIsItsBackground) {
  const Image image = Renderer().render(empty_drawing(33, 17));
  EXPECT_EQ(image.width, 33);
  EXPECT_EQ(image.height, 17);
  for (const std::uint8_t byte : image.rgb) ASSERT_EQ(byte, 255);
}

TEST(Renderer, ALineOnWholePixelsIsExactAndItsTopIsTheImagesTop) {
  Drawing drawing = empty_drawing(60, 40);
  drawing.items.push_back({line({{10, 11}, {50, 11}}, 2), {}});
  const Image image = Renderer().render(drawing);
  for (const int y : {10, 11}) {
    EXPECT_EQ(image.at(10, y), kRed);
    EXPECT_EQ(image.at(49, y), kRed);
    EXPECT_EQ(image.at(9, y), kWhite);
    EXPECT_EQ(image.at(50, y), kWhite);
  }
  EXPECT_EQ(image.at(30, 9), kWhite);
  EXPECT_EQ(image.at(30, 12), kWhite);
}

TEST(Renderer, ASlantedLineIsSmooth) {
  Drawing drawing = empty_drawing(100, 60);
  drawing.items.push_back({line({{10, 20}, {90, 30}}, 2), {}});
  const Image image = Renderer().render(drawing);
  EXPECT_NEAR(total_redness(image), 2 * std::hypot(80, 10), 1);  // its area
  // Sixteen samples: along the edge, many more shades than the five of a pixel's quarters.
  std::vector<int> shades(256, 0);
  for (int x = 15; x < 85; ++x) shades[image.at(x, 24).green] = 1;
  int different = 0;
  for (const int seen : shades) different += seen;
  EXPECT_GT(different, 8);
}

TEST(Renderer, JoinsAreRound) {
  Drawing drawing = empty_drawing(100, 100);
  drawing.items.push_back({line({{20, 60}, {60, 60}, {60, 20}}, 20), {}});
  const Image image = Renderer().render(drawing);
  EXPECT_EQ(image.at(66, 66), kRed);    // within the radius of 10
  EXPECT_EQ(image.at(68, 68), kWhite);  // in the corner that a mitre would fill
  EXPECT_EQ(image.at(45, 45), kWhite);  // inside of the bend
  EXPECT_EQ(image.at(55, 55), kRed);
}

TEST(Renderer, CapsAreRoundOrButt) {
  Drawing drawing = empty_drawing(100, 60);
  drawing.items.push_back({line({{40, 15}, {60, 15}}, 20, LineCap::kButt), {}});
  drawing.items.push_back({line({{40, 45}, {60, 45}}, 20, LineCap::kRound), {}});
  const Image image = Renderer().render(drawing);
  EXPECT_EQ(image.at(38, 15), kWhite);
  EXPECT_EQ(image.at(33, 45), kRed);
  EXPECT_EQ(image.at(61, 15), kWhite);
  EXPECT_EQ(image.at(66, 45), kRed);
  EXPECT_EQ(image.at(31, 37), kWhite);
}

TEST(Renderer, DashesKeepTheirLengthsAroundCorners) {
  Drawing drawing = empty_drawing(100, 100);
  Polyline dashes = line({{10, 20}, {25, 20}, {25, 90}}, 2);
  dashes.dashes = {10, 10};
  drawing.items.push_back({dashes, {}});
  const Image image = Renderer().render(drawing);
  EXPECT_EQ(image.at(15, 20), kRed);    // 0 to 10
  EXPECT_EQ(image.at(22, 20), kWhite);  // 10 to 20, the corner is at 15
  EXPECT_EQ(image.at(25, 23), kWhite);
  EXPECT_EQ(image.at(25, 27), kRed);  // 20 to 30
  EXPECT_EQ(image.at(25, 33), kRed);
  EXPECT_EQ(image.at(25, 37), kWhite);  // 30 to 40
}

TEST(Renderer, PointsThatAreNotFiniteInterruptALine) {
  Drawing drawing = empty_drawing(100, 40);
  drawing.items.push_back({line({{10, 20}, {30, 20}, {kNone, 20}, {60, 20}, {90, 20}}, 4), {}});
  drawing.items.push_back({Disc{{kNone, 5}, 3, kBlue, 1}, {}});
  drawing.items.push_back({Polygon{{{0, 0}, {kNone, 0}, {0, 5}}, kBlue, 1}, {}});
  const Image image = Renderer().render(drawing);
  EXPECT_EQ(image.at(20, 20), kRed);
  EXPECT_EQ(image.at(45, 20), kWhite);
  EXPECT_EQ(image.at(75, 20), kRed);
}

TEST(Renderer, ALineFarOutsideIsNoTrouble) {
  Drawing drawing = empty_drawing(100, 40);
  drawing.items.push_back({line({{-1e300, 20}, {1e300, 20}}, 4), {}});
  EXPECT_EQ(Renderer().render(drawing).at(50, 20), kRed);
}

TEST(Renderer, AVertexColourRunsAlongTheLine) {
  Drawing drawing = empty_drawing(120, 40);
  Polyline coloured = line({{10, 20}, {110, 20}}, 10);
  coloured.colours = {kRed, kBlue};
  drawing.items.push_back({coloured, {}});
  const Image image = Renderer().render(drawing);
  EXPECT_NEAR(image.at(60, 20).red, 128, 3);
  EXPECT_NEAR(image.at(60, 20).blue, 128, 3);
  EXPECT_GT(image.at(20, 20).red, image.at(100, 20).red);
}

TEST(Renderer, ADiscHasItsArea) {
  Drawing drawing = empty_drawing(80, 80);
  drawing.items.push_back({Disc{{40.3, 39.7}, 20, kRed, 1}, {}});
  const Image image = Renderer().render(drawing);
  EXPECT_NEAR(total_redness(image), std::numbers::pi * 400, 8);
  EXPECT_EQ(image.at(40, 40), kRed);
  EXPECT_EQ(image.at(40, 18), kWhite);
}

TEST(Renderer, LaterShapesLieOnTopAndOpacityMixes) {
  Drawing drawing = empty_drawing(40, 40);
  drawing.items.push_back({Polygon{{{0, 0}, {40, 0}, {40, 40}, {0, 40}}, kRed, 1}, {}});
  drawing.items.push_back({Polygon{{{10, 10}, {30, 10}, {30, 30}, {10, 30}}, kBlue, 0.5}, {}});
  const Image image = Renderer().render(drawing);
  EXPECT_EQ(image.at(5, 5), kRed);
  EXPECT_NEAR(image.at(20, 20).red, 127, 1);
  EXPECT_NEAR(image.at(20, 20).blue, 128, 1);
}

TEST(Renderer, AClipCutsWhatIsOutsideAndNothingElse) {
  Drawing drawing = empty_drawing(100, 40);
  drawing.items.push_back({line({{0, 20}, {100, 20}}, 10), Rect{30, 0, 70, 40}});
  drawing.items.push_back({Disc{{10, 10}, 4, kBlue, 1}, {}});
  const Image image = Renderer().render(drawing);
  EXPECT_EQ(image.at(29, 20), kWhite);
  EXPECT_EQ(image.at(30, 20), kRed);
  EXPECT_EQ(image.at(69, 20), kRed);
  EXPECT_EQ(image.at(70, 20), kWhite);
  EXPECT_EQ(image.at(10, 10), kBlue);
  EXPECT_EQ(image.at(99, 39), kWhite);
}

TEST(Renderer, AClipOfTheLastShapeDoesNotCutThePicture) {
  Drawing drawing = empty_drawing(100, 40);
  drawing.items.push_back({Disc{{10, 10}, 4, kBlue, 1}, {}});
  drawing.items.push_back({line({{0, 20}, {100, 20}}, 10), Rect{30, 0, 70, 40}});
  const Image image = Renderer().render(drawing);
  EXPECT_EQ(image.at(10, 10), kBlue);
  EXPECT_EQ(image.at(99, 39), kWhite);
}

PointCloud cloud(std::vector<ScenePoint> points, double diameter) {
  PointCloud result;
  result.points = std::move(points);
  result.camera = Camera::from_above({0, 0}, 10, 10, -5, 5);
  result.viewport = {0, 0, 100, 100};
  result.diameter = diameter;
  return result;
}

TEST(Renderer, TheHigherPointCoversTheLowerInAnyOrder) {
  for (const bool higher_first : {true, false}) {
    std::vector<ScenePoint> points{{0, 0, 3, kRed}, {0, 0, -3, kBlue}};
    if (!higher_first) std::swap(points[0], points[1]);
    Drawing drawing = empty_drawing(100, 100);
    drawing.items.push_back({cloud(points, 6), {}});
    EXPECT_EQ(Renderer().render(drawing).at(50, 50), kRed);
  }
}

TEST(Renderer, PointsStandWhereTheCameraSeesThem) {
  Drawing drawing = empty_drawing(100, 100);
  drawing.items.push_back({cloud({{5, 5, 0, kRed}, {-8, -9, 0, kBlue}}, 4), {}});
  const Image image = Renderer().render(drawing);
  EXPECT_EQ(image.at(75, 25), kRed);  // x to the right, y up
  EXPECT_EQ(image.at(10, 95), kBlue);
  EXPECT_NEAR(total_redness(image), 2 * std::numbers::pi * 4, 3);
}

TEST(Renderer, SplatsAreRoundOrSquare) {
  for (const Splat splat : {Splat::kRound, Splat::kSquare}) {
    Drawing drawing = empty_drawing(100, 100);
    PointCloud one = cloud({{0, 0, 0, kRed}}, 20);
    one.splat = splat;
    drawing.items.push_back({one, {}});
    const Image image = Renderer().render(drawing);
    EXPECT_EQ(image.at(50, 50), kRed);
    EXPECT_EQ(image.at(42, 42), splat == Splat::kSquare ? kRed : kWhite);
  }
}

TEST(Renderer, ACloudStaysInItsViewport) {
  Drawing drawing = empty_drawing(100, 100);
  PointCloud wide = cloud({{0, 0, 0, kRed}, {12, 0, 0, kRed}}, 10);
  wide.viewport = {20, 20, 60, 60};
  drawing.items.push_back({wide, wide.viewport});
  const Image image = Renderer().render(drawing);
  EXPECT_EQ(image.at(40, 40), kRed);
  EXPECT_EQ(image.at(64, 40), kWhite);
}

TEST(Renderer, ALaterCloudCoversAnEarlierOne) {
  Drawing drawing = empty_drawing(100, 100);
  drawing.items.push_back({cloud({{0, 0, 4, kRed}}, 10), {}});
  drawing.items.push_back({cloud({{0, 0, -4, kBlue}}, 4), {}});
  const Image image = Renderer().render(drawing);
  EXPECT_EQ(image.at(50, 50), kBlue);
  EXPECT_EQ(image.at(46, 50), kRed);
}

TEST(Renderer, DepthShadingDarkensWhatLiesBehindAnEdge) {
  std::vector<ScenePoint> points;
  for (int i = -100; i <= 100; ++i) {
    for (int k = -100; k <= 100; ++k) {
      const auto x = static_cast<float>(0.1 * i);
      points.push_back({x, static_cast<float>(0.1 * k), x > 0 ? 4.0F : -4.0F, kRed});
    }
  }
  PointCloud step = cloud(points, 3);
  step.depth_shading = 0.5;
  Drawing drawing = empty_drawing(100, 100);
  drawing.items.push_back({step, {}});
  const Image image = Renderer().render(drawing);
  EXPECT_LT(image.at(48, 50).red, 200);  // low, at the foot of the step
  EXPECT_EQ(image.at(20, 50), kRed);     // low, in the open
  EXPECT_EQ(image.at(54, 50), kRed);     // high, at the edge
}

TEST(Renderer, TextStandsOnItsBaselineInItsColour) {
  Drawing drawing = empty_drawing(200, 60);
  drawing.texts.push_back(
      {"HHH", {20, 40}, 32, FontWeight::kBold, HorizontalAlign::kLeft, kRed, {}});
  const Image image = Renderer().render(drawing);
  EXPECT_EQ(image.at(22, 30), kRed);  // in the first stem
  EXPECT_EQ(image.at(22, 39), kRed);  // down to the baseline
  double below = 0;
  for (int x = 0; x < 200; ++x) below += redness(image, x, 40);
  EXPECT_EQ(below, 0);
  double left = 0;
  for (int y = 0; y < 60; ++y) left += redness(image, 18, y);
  EXPECT_EQ(left, 0);
}

TEST(Renderer, TextOffThePageAndWithoutInkIsNoTrouble) {
  Drawing drawing = empty_drawing(50, 30);
  for (const char* utf8 : {"", " ", "\u202E", "東京", "\xff\xfe"}) {
    for (const Point at : {Point{-40, 10}, Point{45, 29}, Point{500, 500}}) {
      drawing.texts.push_back(
          {utf8, at, 20, FontWeight::kRegular, HorizontalAlign::kLeft, kRed, Colour{0, 255, 0}});
    }
  }
  EXPECT_NO_THROW(Renderer().render(drawing));
}

TEST(Renderer, TilesDoNotShow) {
  const Drawing drawing = sample_drawing(400, 300);
  const Image whole = Renderer().render(drawing);
  Renderer::Options options;
  options.tile_width = 97;
  options.tile_height = 61;
  const Image tiled = Renderer(options).render(drawing);
  int different = 0;
  for (std::size_t i = 0; i < whole.rgb.size(); ++i) {
    different += std::abs(whole.rgb[i] - tiled.rgb[i]) > 2 ? 1 : 0;
  }
  // Corners of triangles are rounded to a grid that begins at the tile: few samples may differ.
  EXPECT_LT(different, static_cast<int>(whole.rgb.size() / 500));
}

TEST(Renderer, AnySizeAlsoBeyondOneTile) {
  Renderer renderer;
  for (const auto& [width, height] : {std::pair{1, 1}, {200, 150}, {5000, 3000}, {20'000, 3}}) {
    Drawing drawing = empty_drawing(width, height);
    drawing.items.push_back({Polygon{{{width - 2.0, height - 2.0},
                                      {double(width), height - 2.0},
                                      {double(width), double(height)},
                                      {width - 2.0, double(height)}},
                                     kRed,
                                     1},
                             {}});
    const Image image = renderer.render(drawing);
    EXPECT_EQ(image.rgb.size(),
              std::size_t{3} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    EXPECT_EQ(image.at(width - 1, height - 1), kRed);
    EXPECT_EQ(image.at(0, 0), width == 1 ? kRed : kWhite);
  }
  EXPECT_THROW(renderer.render(empty_drawing(0, 10)), std::invalid_argument);
  EXPECT_THROW(renderer.render(empty_drawing(10, 40'000)), std::invalid_argument);
  EXPECT_THROW(Renderer({0, 100}), std::invalid_argument);
  EXPECT_THROW(Renderer({100, 9000}), std::invalid_argument);
}

TEST(Renderer, RepeatsItselfToTheByte) {
  const Drawing drawing = sample_drawing(400, 300);
  Renderer renderer;
  const Image first = renderer.render(drawing);
  EXPECT_EQ(renderer.render(drawing), first);
  renderer.render(empty_drawing(700, 100));  // another size in between
  EXPECT_EQ(renderer.render(drawing), first);
  EXPECT_EQ(Renderer().render(drawing), first);
}

TEST(Renderer, MovesBetweenThreads) {
  const Drawing drawing = sample_drawing(400, 300);
  Renderer renderer;
  const Image here = renderer.render(drawing);
  Image there;
  std::thread worker([&there, &drawing, moved = std::move(renderer)]() mutable {
    there = moved.render(drawing);
    Renderer own;
    there = own.render(drawing) == there ? there : Image{};
  });
  worker.join();
  EXPECT_EQ(there, here);
}

TEST(Renderer, TwoWorkAtTheSameTime) {
  const Drawing drawing = sample_drawing(400, 300);
  const Image expected = Renderer().render(drawing);
  std::vector<Image> images(2);
  std::vector<std::thread> workers;
  workers.reserve(images.size());
  for (Image& image : images) {
    workers.emplace_back([&] {
      Renderer renderer;
      for (int i = 0; i < 5; ++i) image = renderer.render(drawing);
    });
  }
  for (std::thread& worker : workers) worker.join();
  EXPECT_EQ(images[0], expected);
  EXPECT_EQ(images[1], expected);
}

}  // namespace
}  // namespace traverse::render
