// Memory of the preset traverse on a loop that is driven again and again.
//
//   odometry_memory_bench [WORLD [LAPS]]      share/worlds/town_loop.yaml, ten laps
//
// After each lap: what the odometry holds, and the most that it has held during a frame, with what
// it needed for a moment. Counted are allocations by operator new while it works.

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <malloc.h>
#include <new>
#include <string>
#include <vector>

#include <tbb/parallel_for.h>

#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/simulation/simulation.hpp"
#include "traverse/voxel_map/voxel_map_odometry.hpp"

namespace {

std::atomic<std::ptrdiff_t> held{0};
std::atomic<std::ptrdiff_t> most{0};

void* allocate(std::size_t bytes) {
  void* memory = std::malloc(std::max<std::size_t>(bytes, 1));
  if (memory == nullptr) throw std::bad_alloc();
  const auto size = static_cast<std::ptrdiff_t>(malloc_usable_size(memory));
  const std::ptrdiff_t now = held += size;
  std::ptrdiff_t known = most;
  while (now > known && !most.compare_exchange_weak(known, now)) {
  }
  return memory;
}

void release(void* memory) {
  held -= static_cast<std::ptrdiff_t>(malloc_usable_size(memory));
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t bytes) { return allocate(bytes); }
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }

namespace traverse {
namespace {

constexpr std::size_t kBatch = 32;  // sweeps simulated at a time
constexpr double kMegabyte = 1e6;

/// What one object allocates by its calls, among whatever else the program does between them.
class Ledger {
 public:
  template <typename Call>
  void during(const Call& call) {
    const std::ptrdiff_t before = held;
    most = before;
    call();
    most_ = std::max(most_, held_ + (most - before));
    held_ += held - before;
  }
  double held_mb() const { return static_cast<double>(held_) / kMegabyte; }
  double max_mb() const { return static_cast<double>(most_) / kMegabyte; }

 private:
  std::ptrdiff_t held_ = 0;
  std::ptrdiff_t most_ = 0;
};

int drive(const std::string& world_name, int laps) {
  const std::string share = TRAVERSE_SHARE_DIR;
  const auto world =
      simulation::load_world(simulation::find_world(world_name, share),
                             {"route.closed=true", "route.laps=" + std::to_string(laps)});
  const auto profile = sensors::load_lidar_profile(share + "/sensors/" + world.sensor + ".yaml");
  const simulation::Simulation simulation(world, profile);
  const std::size_t sweeps = simulation.lidar().sweeps();
  const std::vector<double> driven_m = simulation.truth({0, sweeps}).accumulated_distances();
  const double lap_m = driven_m.back() / laps;
  std::printf("%s, %s: %.0f m a lap, %zu sweeps\n", world.name.c_str(), world.sensor.c_str(), lap_m,
              sweeps);
  std::printf("%4s %8s %10s %12s\n", "lap", "cells", "held MB", "peak MB");

  Ledger ledger;
  voxel_map::VoxelMapOdometry odometry({}, profile, false);
  std::vector<sensors::LidarScan> scans(kBatch);
  int lap = 1;
  for (std::size_t begin = 0; begin < sweeps; begin += kBatch) {
    const std::size_t end = std::min(begin + kBatch, sweeps);
    tbb::parallel_for(begin, end,
                      [&](std::size_t i) { scans[i - begin] = simulation.lidar().scan(i); });
    for (std::size_t i = begin; i < end; ++i) {
      ledger.during([&] { odometry.process(scans[i - begin]); });
      const bool complete = lap < laps ? driven_m[i] >= lap * lap_m : i + 1 == sweeps;
      if (!complete) continue;
      std::printf("%4d %8zu %10.2f %12.2f\n", lap, odometry.map().size(), ledger.held_mb(),
                  ledger.max_mb());
      std::fflush(stdout);
      ++lap;
    }
  }
  return 0;
}

}  // namespace
}  // namespace traverse

int main(int argc, char** argv) {
  return traverse::drive(argc > 1 ? argv[1] : "town_loop", argc > 2 ? std::atoi(argv[2]) : 10);
}
