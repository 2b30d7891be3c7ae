#pragma once

#include <cmath>
#include <random>

#include "traverse/render/drawing.hpp"

namespace traverse::render {

/// Something of everything that a drawing may hold.
inline Drawing sample_drawing(int width, int height) {
  Drawing drawing;
  drawing.width = width;
  drawing.height = height;
  drawing.background = {250, 250, 245};
  const Rect all{0, 0, static_cast<double>(width), static_cast<double>(height)};

  PointCloud cloud;
  std::mt19937 generator(1);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int i = 0; i < 20'000; ++i) {
    const float x = uniform(generator);
    const float y = uniform(generator);
    cloud.points.push_back({x, y, std::sin(6 * x), {static_cast<std::uint8_t>(i % 256), 120, 40}});
  }
  cloud.camera = Camera::from_above({0, 0}, 1.2, 1.2 * height / width, -1, 1);
  cloud.viewport = all;
  cloud.diameter = 3;
  cloud.depth_shading = 0.3;
  drawing.items.push_back({cloud, {}});
  cloud.camera = Camera::looking_at({-2, 0, 1.5}, {0, 0, 0}, 0.8, 1.5, 0.1, 10);
  cloud.viewport = {10, 10, 160, 110};
  cloud.splat = Splat::kSquare;
  drawing.items.push_back({cloud, cloud.viewport});

  Polyline spiral;
  for (int i = 0; i < 600; ++i) {
    const double angle = 0.05 * i;
    spiral.points.push_back(
        {all.centre().x + 0.4 * i * std::cos(angle), all.centre().y + 0.2 * i * std::sin(angle)});
  }
  spiral.colour = {0, 114, 178};
  spiral.width = 2.5;
  drawing.items.push_back({spiral, all.inset(12)});
  spiral.dashes = {7, 5};
  spiral.colour = {30, 30, 30};
  spiral.width = 1.2;
  drawing.items.push_back({spiral, {}});
  drawing.items.push_back({Disc{{90.5, 200.25}, 17, {213, 94, 0}, 0.6}, {}});
  drawing.texts.push_back({"±0.5 °/100 m – µ²",
                           {30, 250},
                           22,
                           FontWeight::kRegular,
                           HorizontalAlign::kLeft,
                           {20, 20, 20},
                           Colour{255, 255, 255}});
  return drawing;
}

}  // namespace traverse::render
