#include "traverse/simulation/worlds.hpp"

#include <random>

namespace traverse::simulation {

namespace {

constexpr double kWorldMargin = 60;  // metres of street before the start and after the end
constexpr double kHalfRoad = 6;      // metres from the middle to the kerb

class Builder {
 public:
  explicit Builder(unsigned seed) : generator_(seed) {}

  double uniform(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(generator_);
  }

  AnalyticScene scene;

  void add_ground(double begin, double end) {
    scene.add(Rectangle{{begin, -80, 0}, {end - begin, 0, 0}, {0, 160, 0}, 0.2});
    for (const double side : {-1.0, 1.0}) {  // kerbs
      scene.add(Rectangle{{begin, side * kHalfRoad, 0}, {end - begin, 0, 0}, {0, 0, 0.15}, 0.4});
    }
  }

  void add_houses(double begin, double end, double side) {
    for (double x = begin; x < end;) {
      const double width = uniform(8, 16);
      const double depth = uniform(6, 10);
      const double setback = kHalfRoad + 3 + uniform(0, 5);
      const double reflectivity = uniform(0.3, 0.7);
      const double height = uniform(6, 14);
      scene.add_box({x + width / 2, side * (setback + depth / 2), 0}, {width, depth, height}, 0,
                    reflectivity);
      x += width + (uniform(0, 1) < 0.3 ? uniform(3, 8) : 0);
    }
  }

  void add_posts(double begin, double end, double side) {
    for (double x = begin; x < end; x += uniform(12, 22)) {
      scene.add(Pole{{x, side * (kHalfRoad + 1), 0}, uniform(0.08, 0.2), uniform(4, 8), 0.6});
    }
  }

  void add_cars(double begin, double end, double side) {
    for (double x = begin; x < end; x += uniform(9, 25)) {
      scene.add_box({x, side * (kHalfRoad - 1.2), 0}, {4.4, 1.8, 1.5}, uniform(-0.03, 0.03), 0.7);
    }
  }

 private:
  std::mt19937 generator_;
};

}  // namespace

AnalyticScene street(double length_m, unsigned seed) {
  Builder builder(seed);
  const double begin = -kWorldMargin;
  const double end = length_m + kWorldMargin;
  builder.add_ground(begin - kWorldMargin, end + kWorldMargin);
  for (const double side : {-1.0, 1.0}) {
    builder.add_houses(begin, end, side);
    builder.add_posts(begin, end, side);
    builder.add_cars(begin, end, side);
  }
  return builder.scene;
}

AnalyticScene tunnel(double length_m) {
  AnalyticScene scene;
  const Eigen::Vector3d along(length_m + 400, 0, 0);
  scene.add(Rectangle{{-200, -4, 0}, along, {0, 8, 0}, 0.3});  // road
  scene.add(Rectangle{{-200, -4, 5}, along, {0, 8, 0}, 0.3});  // ceiling
  scene.add(Rectangle{{-200, -4, 0}, along, {0, 0, 5}, 0.3});  // walls
  scene.add(Rectangle{{-200, 4, 0}, along, {0, 0, 5}, 0.3});
  return scene;
}

}  // namespace traverse::simulation
