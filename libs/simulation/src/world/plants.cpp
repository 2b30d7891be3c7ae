#include "plants.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace traverse::simulation {

namespace {

using Eigen::Vector3d;

Vector3d random_direction(Random& random) {
  const double z = random.gaussian();
  const double y = random.gaussian();
  const double x = random.gaussian();
  return Vector3d(x, y, z).normalized();
}

void add_leaf(Mesh& mesh, const Vector3d& at, double size, Random& random) {
  const Vector3d u = random_direction(random);
  const Vector3d v = u.cross(random_direction(random)).normalized();
  mesh.add_triangle(at - size / 2 * u, at + size / 2 * u, at + size * v, Material::kFoliage);
}

/// Leaves in a ball about `centre`, more of them towards its skin.
void add_clump(Mesh& mesh, const Vector3d& centre, const Vector3d& radii, int leaves, double size,
               Random& random) {
  for (int i = 0; i < leaves; ++i) {
    const double share = std::pow(random.uniform(0.05, 1), 0.45);
    const double scale = random.uniform(0.6, 1.3);
    add_leaf(mesh, centre + share * random_direction(random).cwiseProduct(radii), size * scale,
             random);
  }
}

}  // namespace

Mesh make_tree(double height, Random& random) {
  Mesh mesh;
  const double trunk = height * random.uniform(0.3, 0.4);
  const double radius = 0.02 * height * random.uniform(0.8, 1.3);
  const double aside = random.uniform(-0.2, 0.2);
  const double ahead = random.uniform(-0.2, 0.2);
  const Vector3d fork(ahead, aside, trunk);
  mesh.add_tube({0, 0, -0.5}, fork, radius, 0.75 * radius, kRound, Material::kBark);
  const int branches = 5 + static_cast<int>(random.below(3));
  for (int i = 0; i < branches; ++i) {
    const double angle = 2 * std::numbers::pi * (i + random.uniform(0, 0.6)) / branches;
    const double reach = height * random.uniform(0.12, 0.24);
    const Vector3d tip = fork + Vector3d(reach * std::cos(angle), reach * std::sin(angle),
                                         height * random.uniform(0.2, 0.5));
    mesh.add_tube(fork, tip, 0.5 * radius, 0.15 * radius, 5, Material::kBark);
    const double r = height * random.uniform(0.12, 0.18);
    add_clump(mesh, tip, {r, r, 0.8 * r}, 140, 0.24, random);
  }
  add_clump(mesh, fork + Vector3d(0, 0, 0.42 * height), {0.2 * height, 0.2 * height, 0.22 * height},
            280, 0.25, random);
  return mesh;
}

Mesh make_conifer(double height, Random& random) {
  Mesh mesh;
  mesh.add_tube({0, 0, -0.5}, {0, 0, height}, 0.015 * height, 0.02, kRound, Material::kBark);
  for (int i = 0; i < 900; ++i) {
    const double share = std::sqrt(random.uniform(0, 1));  // from the tip down
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const double reach = share * 0.2 * height * std::sqrt(random.uniform(0.1, 1));
    add_leaf(mesh, {reach * std::cos(angle), reach * std::sin(angle), height * (1 - 0.9 * share)},
             0.24, random);
  }
  return mesh;
}

Mesh make_bush(double radius, Random& random) {
  Mesh mesh;
  add_clump(mesh, {0, 0, 0.6 * radius}, {radius, radius, 0.8 * radius}, 180, 0.16, random);
  return mesh;
}

Mesh make_hedge(double length, double height, Random& random) {
  Mesh mesh;
  const int leaves = static_cast<int>(150 * length);
  for (int i = 0; i < leaves; ++i) {
    const double up = random.uniform(0, height);
    const double across = random.uniform(-0.35, 0.35);
    Vector3d p(random.uniform(-length / 2, length / 2), across, up);
    const double face = random.uniform(0, 1);  // most leaves are near a face
    if (face < 0.4) p.y() = std::copysign(random.uniform(0.28, 0.4), p.y());
    if (face > 0.8) p.z() = height * random.uniform(0.93, 1.02);
    add_leaf(mesh, p, 0.12, random);
  }
  return mesh;
}

Mesh make_tall_grass(double radius, Random& random) {
  Mesh mesh;
  for (int i = 0; i < 120; ++i) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const double r = radius * std::sqrt(random.uniform(0, 1));
    const Vector3d foot(r * std::cos(angle), r * std::sin(angle), -0.05);
    const double lean = random.uniform(0, 2 * std::numbers::pi);
    const double height = random.uniform(0.15, 0.5);
    const Vector3d side(0.03 * std::cos(lean), 0.03 * std::sin(lean), 0);
    mesh.add_triangle(foot - side, foot + side,
                      foot + Vector3d(0.15 * std::sin(lean), -0.15 * std::cos(lean), height),
                      Material::kGrass);
  }
  return mesh;
}

}  // namespace traverse::simulation
