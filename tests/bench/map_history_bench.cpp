// What the window of a replay pays for a large map at each redraw: choosing the points to draw, for
// maps of different sizes. `points` are those chosen.

#include <random>

#include <benchmark/benchmark.h>

#include "traverse/replay/map_history.hpp"

namespace traverse::replay {
namespace {

constexpr std::size_t kBudget = 60'000;
constexpr double kVoxel = 0.25;

/// A road with walls on both sides, as long as it takes.
MapHistory road(std::size_t points) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> across(-30, 30);
  std::uniform_real_distribution<float> up(0, 8);
  std::uniform_real_distribution<float> along(0, 10);
  MapHistory map(kVoxel, points + 100'000);
  for (float x = 0; map.points().size() < points; x += 5) {
    std::vector<Eigen::Vector3f> frame;
    for (int i = 0; i < 4000; ++i) {
      const float ahead = x + along(random);
      frame.emplace_back(ahead, across(random), 0);
      frame.emplace_back(ahead, i % 2 == 0 ? -30 : 30, up(random));
    }
    map.add_frame(frame, {});
  }
  return map;
}

void choose_points(benchmark::State& state) {
  const MapHistory map = road(static_cast<std::size_t>(state.range(0)));
  const Eigen::Vector3f focus = map.points().back();
  std::size_t chosen = 0;
  for (auto step : state) {
    const ChosenPoints points = map.choose(map.frames(), focus, kBudget);
    chosen = points.points.size();
    benchmark::DoNotOptimize(chosen);
  }
  state.counters["points"] = static_cast<double>(chosen);
}
BENCHMARK(choose_points)
    ->Arg(100'000)
    ->Arg(1'000'000)
    ->Arg(4'000'000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace traverse::replay
