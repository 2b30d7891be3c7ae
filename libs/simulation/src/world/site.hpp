#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "traverse/simulation/place.hpp"

#include "ground_plan.hpp"
#include "random.hpp"

namespace traverse::simulation {

/// Where a place is being built.
struct Site {
  const PlaceSettings& settings;
  const Route& route;
  const Terrain& terrain;
  Random random;
  std::optional<Random> other_day;  ///< of what is parked; nothing: what `random` parks
  GroundPlan plan;
  Mesh mesh;

  Site(const PlaceSettings& s, const Route& r, const Terrain& t, std::uint64_t seed,
       double margin_m, std::optional<std::uint64_t> other_drive);

  Eigen::Vector3d on_ground(const Eigen::Vector2d& p, double height = 0) const {
    return {p.x(), p.y(), terrain.height(p.x(), p.y()) + height};
  }

  /// The road that the route follows, from before its start to behind its end.
  Street main_street() const;
};

/// The ground `height` above the terrain, sunk below roads, which have surfaces of their own.
void build_ground(Site& site, Material material, double cell_m, double height);
/// The surface of a street with kerbs and pavements; `number` as in GroundPlan::add_road().
void build_street(Site& site, const Street& street, unsigned number, double half_width);

void build_town(Site& site);
void build_highway(Site& site);
void build_tunnel(Site& site);
void build_park(Site& site);
void build_corridor(Site& site);

}  // namespace traverse::simulation
