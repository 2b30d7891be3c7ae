#include <cmath>
#include <numbers>

#include "furniture.hpp"
#include "scatter.hpp"
#include "site.hpp"

namespace traverse::simulation {

namespace {

/// A steel barrier: a rail on posts.
void add_guard_rail(Site& site, const Street& road, double lateral) {
  sweep(site.mesh, road, site.terrain, {lateral, 0.45}, {lateral, 0.75}, Material::kMetal);
  for (double s = 0; s < road.length_m(); s += 4) {
    const Street::Station at = road.at(s);
    site.mesh.add_box(upright(site.on_ground(at.beside(lateral + 0.08), -0.3), at.heading),
                      {0.1, 0.12, 1.0}, Material::kMetal);
  }
}

void add_lane_marks(Site& site, const Street& road, double half_width) {
  for (const double side : {-1.0, 1.0}) {
    const double inner = side * 1.9;
    const double outer = side * (half_width - 0.6);
    sweep(site.mesh, road, site.terrain, {inner + 0.08, 0.004}, {inner - 0.08, 0.004},
          Material::kMarking);
    sweep(site.mesh, road, site.terrain, {outer + 0.08, 0.004}, {outer - 0.08, 0.004},
          Material::kMarking);
    const double between = 0.5 * (inner + outer);
    for (double s = 0; s + 6 < road.length_m(); s += 18) {
      sweep(site.mesh, road.part(s, s + 6), site.terrain, {between + 0.06, 0.004},
            {between - 0.06, 0.004}, Material::kMarking);
    }
  }
}

/// A bridge that carries a road over this one.
void add_overpass(Site& site, const Street::Station& at, double half_width) {
  const geometry::Pose3 T = upright(site.on_ground(at.point), at.heading);
  const double span = 2 * (half_width + 12);
  site.mesh.add_box(T * upright({0, 0, 5.4}, 0), {9, span, 1.2}, Material::kConcrete);
  for (const double x : {-4.4, 4.4}) {
    site.mesh.add_box(T * upright({x, 0, 6.6}, 0), {0.2, span, 1.0}, Material::kConcrete);
  }
  for (const double y : {-half_width - 3, 0.0, half_width + 3}) {
    for (const double x : {-3.0, 0.0, 3.0}) {
      site.mesh.add_tube(T * Eigen::Vector3d(x, y, -1), T * Eigen::Vector3d(x, y, 5.4), 0.5, 0.5,
                         kRound, Material::kConcrete);
    }
  }
}

void add_noise_wall(Site& site, const Street& part, double lateral) {
  sweep(site.mesh, part, site.terrain, {lateral, -0.3}, {lateral, 3.2}, Material::kConcrete);
  for (double s = part.stations.front().s; s < part.stations.back().s; s += 4) {
    const Street::Station at = part.at(s);
    site.mesh.add_box(upright(site.on_ground(at.beside(lateral), -0.3), at.heading),
                      {0.25, 0.4, 3.7}, Material::kMetal);
  }
}

}  // namespace

void build_highway(Site& site) {
  const double half_width = site.settings.half_width_m;
  const double density = site.settings.density;
  Random& random = site.random;
  const Street road = site.main_street();
  site.plan.add_road(road, half_width, 0);
  build_ground(site, Material::kGrass, 3, -0.05);

  constexpr int kStrips = 8;
  for (int i = 0; i < kStrips; ++i) {
    const double left = half_width * (1 - 2.0 * i / kStrips);
    sweep(site.mesh, road, site.terrain, {left, 0}, {left - 2 * half_width / kStrips, 0},
          Material::kAsphalt);
  }
  const double verge = half_width + site.settings.pavement_m + 3;
  for (const double side : {-1.0, 1.0}) {
    sweep(site.mesh, road, site.terrain, {side * half_width, 0}, {side * verge, 0.02},
          Material::kGrass);
    add_guard_rail(site, road, side * (half_width + 0.4));
  }
  add_guard_rail(site, road, 0.15);
  add_guard_rail(site, road, -0.35);
  add_lane_marks(site, road, half_width);
  if (density == 0) return;

  const Greenery greenery(random);
  for (double s = 120; s < road.length_m(); s += random.uniform(350, 500) / density) {
    const Street::Station at = road.at(s);
    site.mesh.add(make_gantry(2 * half_width + 3), upright(site.on_ground(at.point), at.heading));
  }
  for (double s = 300; s < road.length_m(); s += random.uniform(600, 900) / density) {
    add_overpass(site, road.at(s), half_width);
  }
  for (double s = 60; s < road.length_m(); s += random.uniform(300, 500) / density) {
    const double side = random.chance(0.5) ? 1 : -1;
    const double end = std::min(s + random.uniform(80, 160), road.length_m());
    add_noise_wall(site, road.part(s, end), side * (half_width + 3.5));
  }
  for (double s = 0; s < road.length_m(); s += 50) {  // delineators
    for (const double side : {-1.0, 1.0}) {
      const Street::Station at = road.at(s);
      site.mesh.add_box(upright(site.on_ground(at.beside(side * (half_width + 1))), at.heading),
                        {0.1, 0.12, 1.0}, Material::kSign);
    }
  }
  for (double s = 0; s < road.length_m(); s += random.uniform(5, 16) / density) {
    const double side = random.chance(0.5) ? 1 : -1;
    const Eigen::Vector2d p = road.at(s).beside(side * (half_width + random.uniform(6, 38)));
    const double dice = random.uniform(0, 1);
    plant(site,
          dice < 0.4    ? greenery.trees
          : dice < 0.55 ? greenery.conifers
                        : greenery.bushes,
          p, 2, 0);
  }
}

}  // namespace traverse::simulation
