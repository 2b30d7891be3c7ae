#include "simulated_places.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <tbb/parallel_for.h>

#include "traverse/simulation/simulation.hpp"

namespace traverse::testing {

namespace {

constexpr double kSpacing_m = 2;
constexpr double kBetweenTowns_m = 2000;
constexpr int kThinning = 8;
constexpr std::size_t kTownsAtOnce = 8;

/// The town loop's corners, stretched and turned, with houses of its own.
simulation::WorldDescription town(std::size_t number) {
  const std::string share = TRAVERSE_SHARE_DIR;
  simulation::WorldDescription world =
      simulation::load_world(simulation::find_world("town_loop", share), {});
  std::mt19937 random(static_cast<std::mt19937::result_type>(number));
  std::uniform_real_distribution<double> stretch(1.3, 2);
  const double x_scale = stretch(random);
  const double y_scale = stretch(random);
  const double angle = std::uniform_real_distribution<double>(0, 3)(random);
  std::vector<double>& corners = world.route.waypoints_m;
  for (std::size_t k = 0; k + 1 < corners.size(); k += 2) {
    const double x = x_scale * corners[k];
    const double y = y_scale * corners[k + 1];
    corners[k] = std::cos(angle) * x - std::sin(angle) * y;
    corners[k + 1] = std::sin(angle) * x + std::cos(angle) * y;
  }
  world.route.stops_m.clear();
  world.seed = static_cast<std::int64_t>(number) + 1;
  return world;
}

std::vector<SimulatedPlace> drive_through(std::size_t number,
                                          const sensors::LidarProfile& profile) {
  const simulation::Simulation simulation(town(number), profile);
  const simulation::LidarSimulator& lidar = simulation.lidar();
  std::vector<SimulatedPlace> places;
  for (std::size_t sweep = 0; sweep < lidar.sweeps(); ++sweep) {
    const double seconds = lidar.stamp_s(sweep);
    const double way_m = simulation.motion().progress(seconds).value;
    if (!places.empty() && way_m < places.back().way_m + kSpacing_m) continue;
    const sensors::LidarScan scan = lidar.scan(sweep);
    places.push_back({{scan.x, scan.y, scan.z, {}},
                      simulation.motion().state(seconds).T_map_body.translation,
                      way_m});
  }
  return places;
}

}  // namespace

std::vector<SimulatedPlace> simulated_places(std::size_t count) {
  sensors::LidarProfile profile =
      sensors::load_lidar_profile(std::string(TRAVERSE_SHARE_DIR) + "/sensors/vlp16.yaml");
  profile.firing.period_us *= kThinning;
  std::vector<SimulatedPlace> places;
  double way_m = 0;
  for (std::size_t first = 0; places.size() < count; first += kTownsAtOnce) {
    std::vector<std::vector<SimulatedPlace>> towns(kTownsAtOnce);
    tbb::parallel_for(std::size_t{0}, kTownsAtOnce,
                      [&](std::size_t k) { towns[k] = drive_through(first + k, profile); });
    for (std::size_t k = 0; k < kTownsAtOnce; ++k) {
      for (SimulatedPlace& place : towns[k]) {
        place.p_map.x() += kBetweenTowns_m * static_cast<double>(first + k);
        place.way_m += way_m;
        places.push_back(std::move(place));
      }
      way_m = places.back().way_m + kBetweenTowns_m;
    }
  }
  places.resize(count);
  return places;
}

}  // namespace traverse::testing
