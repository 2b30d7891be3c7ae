#include <cmath>
#include <numbers>
#include <vector>

#include "furniture.hpp"
#include "scatter.hpp"
#include "site.hpp"

namespace traverse::simulation {

namespace {

constexpr double kOpen = 120;   ///< metres of open road before and behind the tunnel
constexpr double kPortal = 12;  ///< metres, half width of its portal wall
constexpr double kCover = 1.2;  ///< metres of earth on top

/// The cross-section above the road from right to left: upright walls, then a vault.
std::vector<Edge> vault(double half_width, double height) {
  std::vector<Edge> section{{-half_width, -0.1}};
  const double springing = std::max(1.0, height - half_width);
  constexpr int kFacets = 14;
  for (int i = 0; i <= kFacets; ++i) {
    const double angle = std::numbers::pi * i / kFacets;
    section.push_back(
        {-half_width * std::cos(angle), springing + (height - springing) * std::sin(angle)});
  }
  section.push_back({half_width, -0.1});
  return section;
}

/// The wall around the mouth: from the cross-section out to a rectangle.
void add_portal(Site& site, const Street::Station& at, const std::vector<Edge>& section,
                double height) {
  const geometry::Pose3 T = upright(site.on_ground(at.point), at.heading);
  const double top = height + kCover + 1;
  const auto outwards = [&](const Edge& edge) -> Eigen::Vector3d {
    return {0, edge.lateral / std::abs(section.front().lateral) * kPortal,
            edge.height <= 0 ? edge.height : top};
  };
  for (std::size_t i = 0; i + 1 < section.size(); ++i) {
    site.mesh.add_quad(T * Eigen::Vector3d(0, section[i].lateral, section[i].height),
                       T * Eigen::Vector3d(0, section[i + 1].lateral, section[i + 1].height),
                       T * outwards(section[i + 1]), T * outwards(section[i]), Material::kConcrete);
  }
}

/// The hill over the tunnel.
void add_hill(Site& site, const Street& tube, double to_wall, double height) {
  const double top = height + kCover;
  sweep(site.mesh, tube, site.terrain, {-to_wall, top}, {to_wall, top}, Material::kGrass);
  for (const double side : {-1.0, 1.0}) {
    sweep(site.mesh, tube, site.terrain, {side * to_wall, top}, {side * kPortal, top - 1},
          Material::kGrass);
    sweep(site.mesh, tube, site.terrain, {side * kPortal, top - 1}, {side * (kPortal + 16), 0},
          Material::kGrass);
  }
}

/// Niches, lamps and signs; what makes a tunnel less featureless.
void equip(Site& site, const Street& tube, double half_width) {
  for (double s = tube.stations.front().s; s < tube.stations.back().s;
       s += 25 / site.settings.density) {
    const Street::Station at = tube.at(s);
    const geometry::Pose3 T = upright(site.on_ground(at.point), at.heading);
    site.mesh.add_box(T * upright({0, half_width - 0.3, 0.8}, 0), {1.2, 0.6, 1.8},
                      Material::kMetal);
    site.mesh.add_box(T * upright({8, -half_width + 0.15, 2}, 0), {0.9, 0.3, 0.6}, Material::kSign);
  }
}

}  // namespace

void build_tunnel(Site& site) {
  const PlaceSettings& settings = site.settings;
  const double half_width = settings.half_width_m;
  const Street road = site.main_street();
  site.plan.add_road(road, half_width, 0);
  build_ground(site, Material::kGrass, 1, 0.05);
  build_street(site, road, 0, half_width);

  const double begin =
      std::min(kOpen + 55, road.length_m() / 3);  // the road begins before the route
  const Street tube = road.part(begin, road.length_m() - begin, 3);
  // The pavements lie inside.
  const double to_wall = half_width + settings.pavement_m - 0.2;
  const std::vector<Edge> section = vault(to_wall, settings.height_m);
  for (std::size_t i = 0; i + 1 < section.size(); ++i) {
    sweep(site.mesh, tube, site.terrain, section[i], section[i + 1], Material::kConcrete);
  }
  for (const auto& end : {tube.stations.front(), tube.stations.back()}) {
    add_portal(site, end, section, settings.height_m);
  }
  add_hill(site, tube, to_wall, settings.height_m);
  if (settings.density > 0) equip(site, tube, to_wall);

  const Greenery greenery(site.random);
  for (double s = 0; s < road.length_m(); s += site.random.uniform(2, 5)) {
    if (s > begin - 3 && s < road.length_m() - begin + 3) continue;
    const double side = site.random.chance(0.5) ? 1 : -1;
    const double lateral = side * site.random.uniform(to_wall + 1.5, to_wall + 30);
    plant(site, site.random.chance(0.5) ? greenery.trees : greenery.bushes,
          road.at(s).beside(lateral), 2, 0);
  }
  for (double s = 10; s < begin - 5; s += 22) {
    for (const double at_s : {s, road.length_m() - s}) {
      const Street::Station at = road.at(at_s);
      site.mesh.add(make_lamp_post(7), upright(site.on_ground(at.beside(-to_wall)), at.heading));
    }
  }
}

}  // namespace traverse::simulation
