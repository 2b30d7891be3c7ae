#include <cmath>
#include <numbers>

#include "furniture.hpp"
#include "site.hpp"

namespace traverse::simulation {

namespace {

constexpr double kRecess = 0.18;     ///< metres: doors stand back in the wall
constexpr double kDoor = 1.0;        ///< metres wide
constexpr double kDoorHeight = 2.1;  ///< metres

void add_wall(Site& site, const Street& part, double lateral) {
  sweep(site.mesh, part, site.terrain, {lateral, 0}, {lateral, site.settings.height_m},
        Material::kPlaster);
}

/// The wall around a door, its reveals and the door.
void add_door(Site& site, const Street& part, double lateral, double side, Material material) {
  const double height = site.settings.height_m;
  const double back = lateral + side * kRecess;
  const Terrain& ground = site.terrain;
  sweep(site.mesh, part, ground, {lateral, kDoorHeight}, {lateral, height}, Material::kPlaster);
  sweep(site.mesh, part, ground, {lateral, kDoorHeight}, {back, kDoorHeight}, Material::kPlaster);
  sweep(site.mesh, part, ground, {back, 0}, {back, kDoorHeight}, material);
  sweep(site.mesh, part, ground, {lateral, 0}, {back, 0}, Material::kPaving);
  for (const auto& end : {part.stations.front(), part.stations.back()}) {
    const auto a = end.beside(lateral);
    const auto b = end.beside(back);
    site.mesh.add_quad(site.on_ground(a), site.on_ground(b), site.on_ground(b, kDoorHeight),
                       site.on_ground(a, kDoorHeight), Material::kPlaster);
  }
}

/// A room that is open towards the corridor.
void add_room(Site& site, const Street& part, double lateral, double side) {
  const double height = site.settings.height_m;
  const double depth = site.random.uniform(3, 6);
  const double back = lateral + side * depth;
  const Terrain& ground = site.terrain;
  sweep(site.mesh, part, ground, {lateral, 0}, {back, 0}, Material::kPaving);
  sweep(site.mesh, part, ground, {lateral, height}, {back, height}, Material::kPlaster);
  sweep(site.mesh, part, ground, {back, 0}, {back, height}, Material::kBrick);
  for (const auto& end : {part.stations.front(), part.stations.back()}) {
    const auto a = end.beside(lateral);
    const auto b = end.beside(back);
    site.mesh.add_quad(site.on_ground(a), site.on_ground(b), site.on_ground(b, height),
                       site.on_ground(a, height), Material::kPlaster);
  }
  const Street::Station middle = part.stations[part.stations.size() / 2];
  const Eigen::Vector2d table =
      middle.beside(lateral + side * depth * site.random.uniform(0.4, 0.7));
  site.mesh.add_box(upright(site.on_ground(table, 0.7), middle.heading), {1.6, 0.8, 0.05},
                    Material::kWood);
  for (const double x : {-0.7, 0.7}) {
    const Eigen::Vector2d leg = table + x * middle.ahead();
    site.mesh.add_box(upright(site.on_ground(leg), middle.heading), {0.06, 0.7, 0.7},
                      Material::kMetal);
  }
}

void add_side(Site& site, const Street& corridor, double half_width, double side) {
  Random& random = site.random;
  const double lateral = side * half_width;
  double s = corridor.stations.front().s;
  const double end = corridor.length_m();
  while (s < end) {
    const double plain = std::min(random.uniform(1.2, 5), end - s);
    add_wall(site, corridor.part(s, s + plain, 0.5), lateral);
    s += plain;
    if (site.settings.density > 0 && random.chance(0.3 * site.settings.density)) {
      // A pillar or a cabinet against the wall.
      const Street::Station at = corridor.at(s - plain / 2);
      const bool pillar = random.chance(0.5);
      Eigen::Vector3d size(0.4, 0.3, site.settings.height_m);
      if (!pillar) {
        const double height = random.uniform(0.9, 1.9);
        size = {random.uniform(0.6, 1.1), 0.4, height};
      }
      const Eigen::Vector2d p = at.beside(side * (half_width - size.y() / 2));
      site.mesh.add_box(upright(site.on_ground(p), at.heading), size,
                        pillar ? Material::kConcrete : Material::kMetal);
    }
    if (s + 4 > end) continue;
    const double dice = random.uniform(0, 1);
    const double width = dice < 0.75 ? kDoor : random.uniform(2.5, 4);
    const Street part = corridor.part(s, s + width, 0.5);
    if (dice < 0.75) {
      add_door(site, part, lateral, side, random.chance(0.8) ? Material::kWood : Material::kGlass);
    } else {
      add_room(site, part, lateral, side);
    }
    s += width;
  }
}

}  // namespace

void build_corridor(Site& site) {
  const PlaceSettings& settings = site.settings;
  const double half_width = settings.half_width_m;
  const Street corridor = site.main_street();
  const Street fine = corridor.part(0, corridor.length_m(), 0.5);
  sweep(site.mesh, fine, site.terrain, {half_width, 0}, {-half_width, 0}, Material::kPaving);
  sweep(site.mesh, fine, site.terrain, {half_width, settings.height_m},
        {-half_width, settings.height_m}, Material::kPlaster);
  for (const double side : {-1.0, 1.0}) add_side(site, corridor, half_width, side);
  for (double s = 3; s < corridor.length_m(); s += 6) {  // lamps below the ceiling
    const Street::Station at = corridor.at(s);
    site.mesh.add_box(upright(site.on_ground(at.point, settings.height_m - 0.12), at.heading),
                      {1.2, 0.25, 0.1}, Material::kMetal);
  }
  if (corridor.closed) return;
  for (const auto& end : {corridor.stations.front(), corridor.stations.back()}) {
    const auto a = end.beside(half_width);
    const auto b = end.beside(-half_width);
    site.mesh.add_quad(site.on_ground(a), site.on_ground(b), site.on_ground(b, settings.height_m),
                       site.on_ground(a, settings.height_m), Material::kBrick);
  }
}

}  // namespace traverse::simulation
