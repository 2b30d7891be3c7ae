#include "house.hpp"

#include <cmath>

namespace traverse::simulation {

namespace {

constexpr double kBelowGround = 1.2;  ///< metres that walls go down: the ground may slope

/// An opening in a wall and what fills it, set back.
struct Opening {
  double x0, x1, z0, z1;
  double depth;
  Material filling;
};

/// Frame of a wall: x along it, z up, y into the house.
struct Wall {
  geometry::Pose3 T;
  Material material;

  Eigen::Vector3d at(double x, double y, double z) const { return T * Eigen::Vector3d(x, y, z); }
};

void add_flat(Mesh& mesh, const Wall& wall, double x0, double x1, double z0, double z1) {
  if (x1 - x0 < 1e-6 || z1 - z0 < 1e-6) return;
  mesh.add_quad(wall.at(x0, 0, z0), wall.at(x1, 0, z0), wall.at(x1, 0, z1), wall.at(x0, 0, z1),
                wall.material);
}

/// The part of a wall around an opening, its reveals and its filling.
void add_bay(Mesh& mesh, const Wall& wall, double x0, double x1, double z0, double z1,
             const Opening& o) {
  add_flat(mesh, wall, x0, o.x0, z0, z1);
  add_flat(mesh, wall, o.x1, x1, z0, z1);
  add_flat(mesh, wall, o.x0, o.x1, z0, o.z0);
  add_flat(mesh, wall, o.x0, o.x1, o.z1, z1);
  const auto reveal = [&](double xa, double za, double xb, double zb) {
    mesh.add_quad(wall.at(xa, 0, za), wall.at(xb, 0, zb), wall.at(xb, o.depth, zb),
                  wall.at(xa, o.depth, za), wall.material);
  };
  reveal(o.x0, o.z0, o.x1, o.z0);
  reveal(o.x0, o.z1, o.x1, o.z1);
  reveal(o.x0, o.z0, o.x0, o.z1);
  reveal(o.x1, o.z0, o.x1, o.z1);
  mesh.add_quad(wall.at(o.x0, o.depth, o.z0), wall.at(o.x1, o.depth, o.z0),
                wall.at(o.x1, o.depth, o.z1), wall.at(o.x0, o.depth, o.z1), o.filling);
}

struct FacadeStyle {
  double floor_height, window_width, window_height, depth;
  bool has_door, has_balconies, has_sills;
};

void add_facade(Mesh& mesh, const Wall& wall, double width, int floors, const FacadeStyle& style,
                Random& random) {
  const int bays = std::max(1, static_cast<int>(width / (style.window_width + 1.6)));
  const double bay = width / bays;
  const int door =
      style.has_door ? static_cast<int>(random.below(static_cast<std::size_t>(bays))) : -1;
  add_flat(mesh, wall, 0, width, -kBelowGround, 0);
  for (int floor = 0; floor < floors; ++floor) {
    const double z0 = floor * style.floor_height;
    for (int i = 0; i < bays; ++i) {
      const double x0 = i * bay;
      const double middle = x0 + bay / 2;
      Opening opening{middle - style.window_width / 2,
                      middle + style.window_width / 2,
                      z0 + 0.9,
                      z0 + 0.9 + style.window_height,
                      style.depth,
                      Material::kGlass};
      if (floor == 0 && i == door) {
        opening = {middle - 0.55, middle + 0.55, z0 + 0.15, z0 + 2.3, 0.35, Material::kWood};
      }
      add_bay(mesh, wall, x0, x0 + bay, z0, z0 + style.floor_height, opening);
      const bool is_window = !(floor == 0 && i == door);
      if (is_window && style.has_sills) {
        mesh.add_box(wall.T * upright({middle, -0.06, z0 + 0.84}, 0),
                     {style.window_width + 0.2, 0.12, 0.06}, Material::kConcrete);
      }
      if (floor > 0 && style.has_balconies && random.chance(0.35)) {
        mesh.add_box(wall.T * upright({middle, -0.6, z0 - 0.1}, 0), {bay * 0.8, 1.2, 0.15},
                     Material::kConcrete);
        mesh.add_box(wall.T * upright({middle, -1.17, z0 + 0.05}, 0), {bay * 0.8, 0.06, 1.0},
                     Material::kMetal);
      }
    }
  }
}

void add_roof(Mesh& mesh, const HousePlan& plan, double eaves, Random& random) {
  const double w = plan.width / 2;
  if (plan.gabled) {
    const double ridge = eaves + 0.35 * plan.depth * random.uniform(0.8, 1.2);
    const double out = 0.4;  // beyond the walls
    const double drop = out * (ridge - eaves) / (plan.depth / 2);
    for (const double y : {-out, plan.depth + out}) {
      mesh.add_quad({-w - out, y, eaves - drop}, {w + out, y, eaves - drop},
                    {w + out, plan.depth / 2, ridge}, {-w - out, plan.depth / 2, ridge},
                    Material::kBrick);
    }
    for (const double x : {-w, w}) {
      mesh.add_triangle({x, 0, eaves}, {x, plan.depth, eaves}, {x, plan.depth / 2, ridge},
                        Material::kPlaster);
    }
    mesh.add_box(upright({w * 0.5, plan.depth / 2, ridge - 0.8}, 0), {0.7, 0.9, 2},
                 Material::kBrick);
    return;
  }
  mesh.add_quad({-w, 0, eaves}, {w, 0, eaves}, {w, plan.depth, eaves}, {-w, plan.depth, eaves},
                Material::kConcrete);
  mesh.add_box(upright({0, 0.15, eaves}, 0), {plan.width, 0.3, 0.6}, Material::kConcrete);
  mesh.add_box(upright({0, plan.depth - 0.15, eaves}, 0), {plan.width, 0.3, 0.6},
               Material::kConcrete);
  mesh.add_box(upright({random.uniform(-w / 2, w / 2), plan.depth / 2, eaves}, 0), {2.5, 3, 2.2},
               Material::kPlaster);
}

}  // namespace

Mesh make_house(const HousePlan& plan, Random& random) {
  const Material material = random.chance(0.45) ? Material::kBrick : Material::kPlaster;
  FacadeStyle style{random.uniform(2.8, 3.3),
                    random.uniform(0.9, 1.5),
                    random.uniform(1.2, 1.6),
                    random.uniform(0.12, 0.3),
                    true,
                    random.chance(0.3),
                    random.chance(0.7)};
  const double w = plan.width / 2;
  constexpr double kQuarter = 1.5707963267948966;
  const auto wall = [&](double x, double y, double yaw) {
    return Wall{upright({x, y, 0}, yaw), material};
  };
  Mesh mesh;
  add_facade(mesh, wall(-w, 0, 0), plan.width, plan.floors, style, random);
  style.has_balconies = false;
  add_facade(mesh, wall(w, plan.depth, 2 * kQuarter), plan.width, plan.floors, style, random);
  style.has_door = false;
  add_facade(mesh, wall(w, 0, kQuarter), plan.depth, plan.floors, style, random);
  add_facade(mesh, wall(-w, plan.depth, -kQuarter), plan.depth, plan.floors, style, random);
  add_roof(mesh, plan, plan.floors * style.floor_height, random);
  return mesh;
}

}  // namespace traverse::simulation
