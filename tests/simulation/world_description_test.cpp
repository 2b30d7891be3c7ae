#include "traverse/simulation/world_description.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

#include "temporary_folder.hpp"

namespace traverse::simulation {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

std::string error_of(const std::string& yaml, const std::vector<std::string>& overrides = {}) {
  const TemporaryFolder folder;
  files::write_text(folder / "bad.yaml", yaml);
  try {
    load_world(folder / "bad.yaml", overrides);
  } catch (const files::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(WorldDescription, EveryShippedWorldLoadsAndSaysWhatItIs) {
  std::size_t worlds = 0;
  for (const auto& entry : std::filesystem::directory_iterator(TRAVERSE_SHARE_DIR "/worlds")) {
    const WorldDescription world = load_world(entry.path(), {});
    EXPECT_FALSE(world.description.empty()) << entry.path();
    EXPECT_TRUE(std::filesystem::exists(TRAVERSE_SHARE_DIR "/sensors/" + world.sensor + ".yaml"));
    ++worlds;
  }
  EXPECT_GE(worlds, 5U);
}

TEST(WorldDescription, BadYamlAndUnknownKeysAreToldWithFileAndLine) {
  EXPECT_THAT(error_of("route:\n  - {"), AllOf(HasSubstr("bad.yaml"), HasSubstr("line 2")));
  EXPECT_THAT(error_of("name: x\nroute:\n  sped_mps: 3\n"),
              AllOf(HasSubstr("bad.yaml, line 3"), HasSubstr("route.speed_mps")));
  EXPECT_THAT(error_of("place: {kind: moon}"), AllOf(HasSubstr("line 1"), HasSubstr("corridor")));
}

TEST(WorldDescription, ARouteThatCannotBeDrivenIsToldWithFileAndLine) {
  EXPECT_THAT(
      error_of("route:\n  waypoints_m: [0, 0, 10, 0, 10, 10]\n  corner_radius_m: 30\n"),
      AllOf(HasSubstr("bad.yaml, line 3"), HasSubstr("route.corner_radius_m"), HasSubstr("30 m")));
  EXPECT_THAT(error_of("route: {waypoints_m: [0, 0, 5]}"),
              AllOf(HasSubstr("line 1"), HasSubstr("3 numbers")));
  EXPECT_THAT(error_of("name: x\n", {"route.stops_m=[500]"}), HasSubstr("--set route.stops_m"));
  EXPECT_THAT(error_of("gnss:\n  outages_s: [4, 2]\n"), HasSubstr("line 2"));
}

TEST(WorldDescription, AnUnknownWorldListsThoseThereAre) {
  try {
    find_world("moon", TRAVERSE_SHARE_DIR);
    FAIL();
  } catch (const files::InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("town_loop"), HasSubstr("'moon'")));
  }
}

TEST(Place, TheSameSeedBuildsTheSamePlace) {
  for (const char* name :
       {"town_short", "terrace_loop", "highway", "tunnel", "park", "corridor_loop"}) {
    const WorldDescription world =
        load_world(find_world(name, TRAVERSE_SHARE_DIR), {"place.density=0.2"});
    const Route route(world.route);
    const Terrain terrain(world.terrain, 1);
    const Place a = build_place(world.place, route, terrain, 1);
    const Place b = build_place(world.place, route, terrain, 1);
    EXPECT_GT(a.still.size(), 1000U) << name;
    EXPECT_EQ(a.still.corners(), b.still.corners()) << name;
    EXPECT_EQ(a.movers.size(), static_cast<std::size_t>(world.place.vehicles)) << name;
    for (const auto& corner : a.still.corners()) ASSERT_TRUE(corner.allFinite()) << name;
    const Place c = build_place(world.place, route, terrain, 2);
    EXPECT_NE(a.still.corners(), c.still.corners()) << name;
  }
}

/// A number that each corner and their order tell on.
double checksum(const Place& place) {
  double sum = 0;
  std::size_t i = 0;
  const auto add = [&](const Eigen::Vector3d& p) {
    sum += static_cast<double>(++i % 97) * (p.x() + 2 * p.y() + 3 * p.z());
  };
  for (const auto& corner : place.still.corners()) add(corner);
  for (const auto& mover : place.movers) add(mover.T_map_mover(0).translation);
  return sum;
}

// Seen with GCC 12 and with clang 14: two draws in one expression once had each compiler's own
// order.
TEST(Place, EveryCompilerBuildsThesePlaces) {
  struct Known {
    const char* name;
    std::size_t corners;
    double checksum;
  };
  for (const Known& known : {Known{"town_short", 370142, 1.8563039e+09},
                             {"terrace_loop", 577138, 4.2258097e+09},
                             {"highway", 799340, 5.3931277e+10},
                             {"tunnel", 707572, 1.0847145e+10},
                             {"park", 871144, 5.7479867e+09},
                             {"corridor_loop", 6060, 11671135}}) {
    const WorldDescription world = load_world(find_world(known.name, TRAVERSE_SHARE_DIR),
                                              {"place.density=0.2", "place.vehicles=2"});
    const Route route(world.route);
    const Terrain terrain(world.terrain, 1);
    const Place place = build_place(world.place, route, terrain, 1);
    EXPECT_EQ(place.still.corners().size(), known.corners) << known.name;
    EXPECT_NEAR(checksum(place), known.checksum, 1e-6 * std::abs(known.checksum)) << known.name;
  }
}

TEST(Place, AnotherDriveMovesTrafficAndParkedCarsAlone) {
  const WorldDescription world =
      load_world(find_world("town_short", TRAVERSE_SHARE_DIR), {"place.vehicles=2"});
  const Route route(world.route);
  const Terrain terrain(world.terrain, 1);
  const auto triangles = [&](const Place& place) {
    std::vector<std::array<double, 9>> all;
    for (const auto& corners : place.still.triangles()) {
      std::array<double, 9> triangle{};
      for (std::size_t k = 0; k < 9; ++k) {
        triangle[k] = place.still.corners()[corners[k / 3]][static_cast<Eigen::Index>(k % 3)];
      }
      all.push_back(triangle);
    }
    std::sort(all.begin(), all.end());
    return all;
  };
  const Place own = build_place(world.place, route, terrain, 1);
  const Place other = build_place(world.place, route, terrain, 1, 2);
  const auto before = triangles(own);
  const auto after = triangles(other);
  std::vector<std::array<double, 9>> shared;
  std::set_intersection(before.begin(), before.end(), after.begin(), after.end(),
                        std::back_inserter(shared));
  EXPECT_LT(after.size(), before.size()) << "some cars have left";
  EXPECT_LT(shared.size(), after.size()) << "some are others";
  EXPECT_GT(static_cast<double>(shared.size()), 0.9 * static_cast<double>(before.size()));
  EXPECT_NE(own.movers[0].T_map_mover(0).translation, other.movers[0].T_map_mover(0).translation);
}

TEST(Place, NothingStandsInTheVehiclesWay) {
  for (const char* name :
       {"town_loop", "town_large", "terrace_loop", "highway", "tunnel", "park", "corridor_loop"}) {
    const WorldDescription world = load_world(find_world(name, TRAVERSE_SHARE_DIR), {});
    const Route road(world.route);
    const Terrain terrain(world.terrain, static_cast<std::uint64_t>(world.seed));
    const Place place =
        build_place(world.place, road, terrain, static_cast<std::uint64_t>(world.seed));
    const RayCaster caster(place.still);
    const double half_width = world.place.kind == PlaceKind::kCorridor ? 0.4 : 0.9;
    for (const Route& driven : {road, Route(world.route, 1), Route(world.route, 2)}) {
      for (double s = 1; s < driven.lap_m(); s += 1) {
        const double heading = driven.heading(s);
        const Eigen::Vector3d left(-std::sin(heading), std::cos(heading), 0);
        const Eigen::Vector2d p = driven.point(s);
        const Eigen::Vector3d middle(p.x(), p.y(), terrain.height(p.x(), p.y()) + 0.8);
        for (const double side : {-1.0, 1.0}) {
          EXPECT_FALSE(caster.cast({middle, side * left}, half_width).is_hit())
              << name << " at " << s << " m";
        }
      }
    }
  }
}

/// Parts of the place's mesh that stand on the stretch of its first street from `from` to `to`,
/// counted by corners that are higher than cars.
std::size_t corners_above(const Place& place, double from, double to) {
  std::size_t count = 0;
  for (const auto& corner : place.still.corners()) {
    count += corner.x() >= from && corner.x() < to && std::abs(corner.y()) < 16 && corner.z() > 3;
  }
  return count;
}

TEST(Place, TerracedHousesRepeat) {
  const auto build = [](const char* terraced) {
    const WorldDescription world = load_world(find_world("terrace_loop", TRAVERSE_SHARE_DIR),
                                              {"place.density=0", "terrain.relief_m=0", terraced});
    return build_place(world.place, Route(world.route), Terrain(world.terrain, 1), 1);
  };
  const Place alike = build("place.terraced=true");
  const Place various = build("place.terraced=false");
  constexpr double kHouse = 12.01;
  const std::size_t first = corners_above(alike, 14, 14 + kHouse);
  EXPECT_GT(first, 500U);
  EXPECT_NEAR(static_cast<double>(corners_above(alike, 14 + kHouse, 14 + 2 * kHouse)),
              static_cast<double>(first), 0.02 * static_cast<double>(first));
  EXPECT_GT(std::abs(static_cast<double>(corners_above(various, 14 + kHouse, 14 + 2 * kHouse)) -
                     static_cast<double>(corners_above(various, 14, 14 + kHouse))),
            0.02 * static_cast<double>(first));
}

}  // namespace
}  // namespace traverse::simulation
