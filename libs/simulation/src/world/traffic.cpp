#include "traffic.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "furniture.hpp"

namespace traverse::simulation {

namespace {

/// A way beside the route: `speed` along it (negative: against it), `lateral` to its left.
struct Way {
  Route route;
  Terrain terrain;
  double start, speed, lateral;

  geometry::Pose3 at(double seconds) const {
    const double s =
        std::fmod(std::fmod(start + speed * seconds, route.lap_m()) + route.lap_m(), route.lap_m());
    const double heading = route.heading(s);
    const Eigen::Vector2d p =
        route.point(s) + lateral * Eigen::Vector2d(-std::sin(heading), std::cos(heading));
    return upright({p.x(), p.y(), terrain.height(p.x(), p.y())},
                   heading + (speed < 0 ? std::numbers::pi : 0));
  }
};

}  // namespace

void add_traffic(Place& place, const PlaceSettings& settings, const Route& route,
                 const Terrain& terrain, Random& random) {
  const auto add = [&](Mesh shape, double speed, double lateral) {
    place.shapes.push_back(std::move(shape));
    const Way way{route, terrain, random.uniform(0, route.lap_m()), speed, lateral};
    place.movers.push_back({place.shapes.size() - 1, [way](double t) { return way.at(t); }});
  };
  const bool is_highway = settings.kind == PlaceKind::kHighway;
  for (int i = 0; i < settings.vehicles; ++i) {
    const double speed = is_highway ? random.uniform(22, 36) : random.uniform(6, 11);
    const double lateral = 2 * settings.lane_offset_m + random.uniform(-0.3, 0.3);
    add(random.chance(0.2) ? make_lorry() : make_car(random), -speed, lateral);
  }
  const double kerb = settings.half_width_m + 0.5 * settings.pavement_m;
  for (int i = 0; i < settings.pedestrians; ++i) {
    const double side = random.chance(0.5) ? 1 : -1;
    const double inside =
        settings.kind == PlaceKind::kCorridor ? 0.6 * settings.half_width_m : kerb;
    const double lateral = settings.lane_offset_m + side * (inside + random.uniform(-0.4, 0.4));
    const double direction = random.chance(0.5) ? 1 : -1;
    const double speed = direction * random.uniform(0.9, 1.7);
    add(make_pedestrian(random), speed, lateral);
  }
}

}  // namespace traverse::simulation
