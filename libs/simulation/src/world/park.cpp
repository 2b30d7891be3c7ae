#include <cmath>
#include <numbers>

#include "furniture.hpp"
#include "plants.hpp"
#include "scatter.hpp"
#include "site.hpp"

namespace traverse::simulation {

void build_park(Site& site) {
  Random& random = site.random;
  const PlaceSettings& settings = site.settings;
  const Street path = site.main_street();
  site.plan.add_road(path, settings.half_width_m + 0.6, 0);
  // A gravel path that lies on the lawn without kerbs.
  build_ground(site, Material::kGrass, 1, -0.02);
  sweep(site.mesh, path, site.terrain, {settings.half_width_m, 0}, {0, 0.02}, Material::kSoil);
  sweep(site.mesh, path, site.terrain, {0, 0.02}, {-settings.half_width_m, 0}, Material::kSoil);
  for (const double side : {-1.0, 1.0}) {
    sweep(site.mesh, path, site.terrain, {side * settings.half_width_m, 0},
          {side * (settings.half_width_m + 3), -0.03}, Material::kGrass);
  }
  if (settings.density == 0) return;

  const Greenery greenery(random);
  const Assortment tufts(4, [&](std::size_t) { return make_tall_grass(1.5, random); });
  for (double s = 5; s < path.length_m(); s += random.uniform(18, 40) / settings.density) {
    const double side = random.chance(0.5) ? 1 : -1;
    const Street::Station at = path.at(s);
    const Eigen::Vector2d p = at.beside(side * (settings.half_width_m + 1));
    if (!site.plan.is_free(p, at.heading, {2, 0.6})) continue;
    site.plan.take(p, at.heading, {2, 1});
    const double facing = at.heading - side * std::numbers::pi / 2;
    const double dice = random.uniform(0, 1);
    site.mesh.add(dice < 0.5   ? make_bench()
                  : dice < 0.7 ? make_bin()
                               : make_lamp_post(4),
                  upright(site.on_ground(p), facing));
  }
  const Eigen::Vector2d size = site.plan.most() - site.plan.least();
  const auto somewhere = [&]() -> Eigen::Vector2d {
    const double north = random.uniform(0, 1);
    const double east = random.uniform(0, 1);
    return site.plan.least() + size.cwiseProduct(Eigen::Vector2d(east, north));
  };
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector2d p = somewhere();
    if (!site.plan.is_free(p, 0, {9, 9})) continue;
    site.plan.take(p, 0, {9, 9});
    const double yaw = random.uniform(0, 1);
    site.mesh.add(make_pavilion(random), upright(site.on_ground(p), yaw));
  }
  const auto count = static_cast<int>(settings.density * size.x() * size.y() / 30);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d p = somewhere();
    const double dice = random.uniform(0, 1);
    if (dice < 0.4) plant(site, greenery.trees, p, 3, 0, 0.8, 1.5);
    if (dice > 0.4 && dice < 0.52) plant(site, greenery.conifers, p, 3, 0);
    if (dice > 0.52 && dice < 0.7) plant(site, greenery.bushes, p, 1.2, 0);
    if (dice > 0.7) plant(site, tufts, p, 1, 0);
  }
}

}  // namespace traverse::simulation
