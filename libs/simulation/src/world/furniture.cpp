#include "furniture.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace traverse::simulation {

namespace {

using Eigen::Vector3d;

/// A body of given width along y whose side view is the polygon `profile` (x, z).
void add_extrusion(Mesh& mesh, const std::vector<Eigen::Vector2d>& profile, double width,
                   Material material) {
  const auto at = [&](std::size_t i, double y) {
    const Eigen::Vector2d& p = profile[i % profile.size()];
    return Vector3d(p.x(), y, p.y());
  };
  for (std::size_t i = 0; i < profile.size(); ++i) {
    mesh.add_quad(at(i, -width / 2), at(i + 1, -width / 2), at(i + 1, width / 2), at(i, width / 2),
                  material);
  }
  for (const double y : {-width / 2, width / 2}) {
    for (std::size_t i = 1; i + 1 < profile.size(); ++i) {
      mesh.add_triangle(at(0, y), at(i, y), at(i + 1, y), material);
    }
  }
}

void add_wheel(Mesh& mesh, double x, double y, double radius) {
  constexpr double kHalfWidth = 0.11;
  const Vector3d inner(x, y - kHalfWidth, radius);
  const Vector3d outer(x, y + kHalfWidth, radius);
  mesh.add_tube(inner, outer, radius, radius, 12, Material::kTyre);
  mesh.add_disc(inner, Vector3d::UnitY(), radius, 12, Material::kTyre);
  mesh.add_disc(outer, Vector3d::UnitY(), radius, 12, Material::kTyre);
}

}  // namespace

Mesh make_car(Random& random) {
  const double l = random.uniform(3.9, 4.9);
  const double w = random.uniform(1.7, 1.9);
  const double h = random.uniform(1.42, 1.75);
  const double hood = random.uniform(0.75, 0.95);
  const double boot = random.chance(0.4) ? 0.85 : 0.25;  // saloon or hatchback
  Mesh mesh;
  add_extrusion(mesh,
                {{-l / 2, 0.3},
                 {l / 2, 0.3},
                 {l / 2, 0.65},
                 {l / 2 - 0.15, hood - 0.1},
                 {l / 2 - 1.1, hood},
                 {-l / 2 + 0.1, hood},
                 {-l / 2, 0.7}},
                w, Material::kPaint);
  add_extrusion(
      mesh,
      {{l / 2 - 1.1, hood}, {l / 2 - 1.8, h}, {-l / 2 + boot + 0.4, h}, {-l / 2 + boot, hood}},
      w - 0.25, Material::kGlass);
  mesh.add_box(upright({(boot - 0.7) / 2 - 0.35, 0, h}, 0), {l - 2.3 - boot, w - 0.3, 0.03},
               Material::kPaint);
  for (const double x : {-0.3 * l, 0.3 * l}) {
    for (const double y : {-w / 2 + 0.1, w / 2 - 0.1}) add_wheel(mesh, x, y, 0.32);
  }
  return mesh;
}

Mesh make_lorry() {
  Mesh mesh;
  mesh.add_box(upright({-1.2, 0, 1.1}, 0), {8, 2.5, 2.9}, Material::kPlaster);
  mesh.add_box(upright({4, 0, 0.5}, 0), {2, 2.4, 2.6}, Material::kPaint);
  mesh.add_box(upright({-0.5, 0, 0.7}, 0), {9, 1, 0.4}, Material::kMetal);
  for (const double x : {-4.2, -3.1, 3.6}) {
    for (const double y : {-1.1, 1.1}) add_wheel(mesh, x, y, 0.5);
  }
  return mesh;
}

Mesh make_lamp_post(double height) {
  Mesh mesh;
  mesh.add_tube({0, 0, -0.5}, {0, 0, 1}, 0.11, 0.1, kRound, Material::kMetal);
  mesh.add_tube({0, 0, 1}, {0, 0, height}, 0.08, 0.05, kRound, Material::kMetal);
  mesh.add_tube({0, 0, height}, {0, 1.4, height + 0.3}, 0.04, 0.04, 6, Material::kMetal);
  mesh.add_box(upright({0, 1.6, height + 0.22}, 0), {0.25, 0.6, 0.12}, Material::kMetal);
  return mesh;
}

Mesh make_sign(Random& random) {
  Mesh mesh;
  const double height = random.uniform(2.2, 2.6);
  const double size = random.uniform(0.5, 0.8);
  mesh.add_tube({0, 0, -0.5}, {0, 0, height + size}, 0.035, 0.035, kRound, Material::kMetal);
  mesh.add_box(upright({0.05, 0, height}, 0), {0.02, size, size}, Material::kSign);
  return mesh;
}

Mesh make_traffic_light() {
  Mesh mesh;
  mesh.add_tube({0, 0, -0.5}, {0, 0, 3.4}, 0.07, 0.06, kRound, Material::kMetal);
  mesh.add_box(upright({0.15, 0, 2.4}, 0), {0.22, 0.3, 0.95}, Material::kMetal);
  return mesh;
}

Mesh make_bench() {
  Mesh mesh;
  mesh.add_box(upright({0, 0, 0.42}, 0), {0.45, 1.8, 0.06}, Material::kWood);
  mesh.add_box(upright({-0.22, 0, 0.5}, 0), {0.05, 1.8, 0.4}, Material::kWood);
  for (const double y : {-0.7, 0.7}) {
    mesh.add_box(upright({0, y, -0.1}, 0), {0.4, 0.08, 0.52}, Material::kMetal);
  }
  return mesh;
}

Mesh make_bin() {
  Mesh mesh;
  mesh.add_tube({0, 0, -0.1}, {0, 0, 0.9}, 0.22, 0.26, kRound, Material::kMetal);
  mesh.add_disc({0, 0, 0.9}, Vector3d::UnitZ(), 0.26, kRound, Material::kMetal);
  return mesh;
}

Mesh make_bus_shelter() {
  Mesh mesh;
  mesh.add_box(upright({-0.7, 0, 0}, 0), {0.05, 4, 2.3}, Material::kGlass);
  mesh.add_box(upright({0, 0, 2.35}, 0), {1.6, 4.2, 0.12}, Material::kMetal);
  for (const double y : {-2.0, 2.0}) {
    mesh.add_box(upright({0, y, -0.2}, 0), {1.3, 0.06, 2.5}, Material::kGlass);
    mesh.add_tube({-0.7, y, -0.2}, {-0.7, y, 2.35}, 0.05, 0.05, kRound, Material::kMetal);
  }
  mesh.add_box(upright({-0.35, 0, 0.45}, 0), {0.35, 3, 0.05}, Material::kWood);
  return mesh;
}

Mesh make_pedestrian(Random& random) {
  Mesh mesh;
  const double h = random.uniform(1.55, 1.9);
  for (const double y : {-0.1, 0.1}) {
    mesh.add_tube({y, y, 0}, {0, y, 0.48 * h}, 0.07, 0.09, 6, Material::kCloth);
    mesh.add_tube({0, 2.2 * y, 0.8 * h}, {-y, 2.4 * y, 0.45 * h}, 0.05, 0.045, 6, Material::kCloth);
  }
  mesh.add_tube({0, 0, 0.47 * h}, {0, 0, 0.83 * h}, 0.17, 0.19, 10, Material::kCloth);
  mesh.add_tube({0, 0, 0.85 * h}, {0, 0, h}, 0.09, 0.08, 8, Material::kCloth);
  mesh.add_disc({0, 0, h}, Vector3d::UnitZ(), 0.08, 8, Material::kCloth);
  return mesh;
}

Mesh make_gantry(double span) {
  Mesh mesh;
  for (const double y : {-span / 2, span / 2}) {
    mesh.add_box(upright({0, y, -0.5}, 0), {0.4, 0.4, 7}, Material::kMetal);
  }
  for (const double z : {6.0, 7.0}) {
    mesh.add_box(upright({0, 0, z}, 0), {0.25, span, 0.25}, Material::kMetal);
  }
  for (const double y : {-span / 4, span / 4}) {
    mesh.add_box(upright({-0.3, y, 5.6}, 0), {0.1, span / 4, 2.2}, Material::kSign);
  }
  return mesh;
}

Mesh make_pavilion(Random& random) {
  Mesh mesh;
  const double r = random.uniform(2.5, 3.5);
  constexpr int kPosts = 8;
  for (int i = 0; i < kPosts; ++i) {
    const double a = 2 * std::numbers::pi * i / kPosts;
    mesh.add_tube({r * std::cos(a), r * std::sin(a), -0.5}, {r * std::cos(a), r * std::sin(a), 2.8},
                  0.09, 0.09, 6, Material::kWood);
  }
  mesh.add_tube({0, 0, 2.8}, {0, 0, 4.2}, r + 0.5, 0.05, kPosts, Material::kWood);
  mesh.add_tube({0, 0, -0.5}, {0, 0, 0.2}, r + 0.3, r + 0.3, kPosts, Material::kConcrete);
  mesh.add_disc({0, 0, 0.2}, Vector3d::UnitZ(), r + 0.3, kPosts, Material::kConcrete);
  return mesh;
}

}  // namespace traverse::simulation
