#include "traverse/simulation/place.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "site.hpp"
#include "traffic.hpp"

namespace traverse::simulation {

using config::Range;

namespace {

constexpr double kMargin = 70;  ///< metres of ground around the route

void build(Site& site) {
  switch (site.settings.kind) {
    case PlaceKind::kTown:
      return build_town(site);
    case PlaceKind::kHighway:
      return build_highway(site);
    case PlaceKind::kTunnel:
      return build_tunnel(site);
    case PlaceKind::kPark:
      return build_park(site);
    case PlaceKind::kCorridor:
      return build_corridor(site);
  }
}

}  // namespace

void bind(config::Binder& b, PlaceSettings& s) {
  static constexpr std::array<std::pair<std::string_view, PlaceKind>, 5> kKinds{
      {{"town", PlaceKind::kTown},
       {"highway", PlaceKind::kHighway},
       {"tunnel", PlaceKind::kTunnel},
       {"park", PlaceKind::kPark},
       {"corridor", PlaceKind::kCorridor}}};
  b.choice("kind", s.kind, kKinds, "kind of place along the route");
  b.number("half_width_m", s.half_width_m, Range::between(0.8, 30), "of the road or corridor");
  b.number("lane_offset_m", s.lane_offset_m, Range::between(-20, 20),
           "of the route to the right of the road's middle");
  b.number("pavement_m", s.pavement_m, Range::between(1.5, 10), "beside a street");
  b.number("height_m", s.height_m, Range::between(2.2, 20), "of a tunnel or corridor");
  b.number("density", s.density, Range::between(0, 3), "of trees, parked cars and furniture");
  b.flag("terraced", s.terraced, "a town of houses that are all alike, wall to wall");
  b.integer("vehicles", s.vehicles, Range::between(0, 200), "vehicles in the opposite lane");
  b.integer("pedestrians", s.pedestrians, Range::between(0, 500), "walking pedestrians");
}

Place build_place(const PlaceSettings& settings, const Route& route, const Terrain& terrain,
                  std::uint64_t seed, std::optional<std::uint64_t> other_drive) {
  Site site(settings, route, terrain, seed, kMargin, other_drive);
  build(site);
  Place place;
  place.still = std::move(site.mesh);
  Random random(other_drive.value_or(seed) + 1);
  add_traffic(place, settings, route, terrain, random);
  return place;
}

}  // namespace traverse::simulation
