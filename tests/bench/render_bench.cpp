/// Milliseconds for the pictures of a report, 1600x1000 where nothing else is said.
#include <cmath>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "traverse/geometry/trajectory.hpp"
#include "traverse/render/pictures/map_from_above.hpp"
#include "traverse/render/pictures/trajectory_from_above.hpp"
#include "traverse/render/renderer.hpp"

namespace traverse::render {
namespace {

struct Cloud {
  std::vector<float> x, y, z;
};

/// A street of 400 m: road, facades and poles.
Cloud street(std::size_t points) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  Cloud cloud;
  for (std::size_t i = 0; i < points; ++i) {
    const float along = 400 * uniform(generator);
    const float side = uniform(generator) < 0.5F ? -1.0F : 1.0F;
    const bool facade = i % 3 == 0;
    cloud.x.push_back(along);
    cloud.y.push_back(facade ? 12 * side : 24 * (uniform(generator) - 0.5F));
    cloud.z.push_back(facade ? 9 * uniform(generator) : 0.05F * uniform(generator));
  }
  return cloud;
}

geometry::Trajectory drive(std::size_t poses) {
  std::vector<geometry::Pose3> path(poses);
  for (std::size_t i = 0; i < poses; ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(poses);
    path[i].translation = {400 * s, 3 * std::sin(20 * s), 0};
  }
  return geometry::Trajectory::unstamped(path);
}

void map_layout_and_render(benchmark::State& state) {
  const Cloud cloud = street(static_cast<std::size_t>(state.range(0)));
  const geometry::Trajectory trajectory = drive(5000);
  Renderer renderer;
  for (auto _ : state) {
    const Drawing drawing = map_from_above({cloud.x, cloud.y, cloud.z}, {}, &trajectory, {}, {});
    benchmark::DoNotOptimize(renderer.render(drawing));
  }
}
BENCHMARK(map_layout_and_render)
    ->Arg(100'000)
    ->Arg(1'000'000)
    ->Arg(5'000'000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Points alone at 1920x1080: what the budget of half a second for a million is about.
void million_points_full_hd(benchmark::State& state) {
  const Cloud cloud = street(1'000'000);
  Style style;
  style.width = 1920;
  style.height = 1080;
  const Drawing drawing = map_from_above({cloud.x, cloud.y, cloud.z}, {}, nullptr, {}, style);
  Renderer renderer;
  for (auto _ : state) benchmark::DoNotOptimize(renderer.render(drawing));
}
BENCHMARK(million_points_full_hd)->Unit(benchmark::kMillisecond)->UseRealTime();

void trajectory_layout_and_render(benchmark::State& state) {
  const geometry::Trajectory trajectory = drive(static_cast<std::size_t>(state.range(0)));
  const std::vector<NamedTrajectory> estimates{{"estimate", &trajectory}};
  Renderer renderer;
  for (auto _ : state) {
    const Drawing drawing = trajectory_from_above(estimates, &trajectory, {}, {});
    benchmark::DoNotOptimize(renderer.render(drawing));
  }
}
BENCHMARK(trajectory_layout_and_render)
    ->Arg(100)
    ->Arg(5000)
    ->Arg(100'000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void png(benchmark::State& state) {
  const Cloud cloud = street(1'000'000);
  const Image image =
      Renderer().render(map_from_above({cloud.x, cloud.y, cloud.z}, {}, nullptr, {}, {}));
  for (auto _ : state) benchmark::DoNotOptimize(image.encode_png());
}
BENCHMARK(png)->Unit(benchmark::kMillisecond);

void renderer_start(benchmark::State& state) {
  for (auto _ : state) Renderer renderer;
}
BENCHMARK(renderer_start)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace traverse::render
