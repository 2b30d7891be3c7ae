#include "traverse/simulation/ray_caster.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "traverse/simulation/analytic_scene.hpp"
#include "traverse/simulation/surroundings.hpp"

namespace traverse::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kReach = 200;

/// The same boxes and ground as closed formulas and as triangles, 400 m from the origin.
struct Both {
  AnalyticScene formulas;
  Mesh mesh;
  Vector3d middle{400, -300, 20};

  Both() {
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int i = 0; i < 25; ++i) {
      const Vector3d base = middle + Vector3d{40 * uniform(generator), 40 * uniform(generator), 0};
      const Vector3d size{2 + uniform(generator), 3 + uniform(generator), 6 + uniform(generator)};
      const double yaw = 3 * uniform(generator);
      formulas.add_box(base, size, yaw, 0.5);
      mesh.add_box(upright(base, yaw), size, Material::kPlaster);
    }
    const Vector3d corner = middle + Vector3d(-60, -60, 0);
    formulas.add(Rectangle{corner, {120, 0, 0}, {0, 120, 0}, 0.2});
    mesh.add_quad(corner, corner + Vector3d(120, 0, 0), corner + Vector3d(120, 120, 0),
                  corner + Vector3d(0, 120, 0), Material::kAsphalt);
  }
};

TEST(RayCaster, DistancesAreThoseOfTheFormulasToRounding) {
  const Both both;
  const RayCaster caster(both.mesh);
  std::mt19937 generator(5);
  std::normal_distribution<double> gaussian;
  std::vector<Ray> rays;
  for (int i = 0; i < 4000; ++i) {
    const Vector3d direction{gaussian(generator), gaussian(generator), 0.3 * gaussian(generator)};
    rays.push_back({both.middle + Vector3d(0.3, 0.2, 2.5), direction.normalized()});
  }
  std::vector<SurfaceHit> hits(rays.size());
  caster.cast(rays, kReach, hits);
  int compared = 0;
  int different = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto formula = both.formulas.first_hit(rays[i].origin, rays[i].direction, kReach);
    if (formula.has_value() != hits[i].is_hit() ||
        (formula && std::abs(formula->distance_m - hits[i].distance_m) > 1e-9)) {
      ++different;  // a ray through an edge, where single precision takes the other side
      continue;
    }
    if (!formula) continue;
    ++compared;
    EXPECT_NEAR(hits[i].cosine, std::abs(formula->normal.dot(rays[i].direction)), 1e-9);
  }
  EXPECT_GT(compared, 2000);
  EXPECT_LE(different, 2);
}

TEST(RayCaster, SkyAndBeyondReachAreNoHits) {
  const Both both;
  const RayCaster caster(both.mesh);
  EXPECT_FALSE(caster.cast({both.middle + Vector3d(0, 0, 9), {0, 0, 1}}, kReach).is_hit());
  const Ray down{both.middle + Vector3d(50, 50, 5), {0, 0, -1}};
  EXPECT_NEAR(caster.cast(down, kReach).distance_m, 5, 1e-12);
  EXPECT_EQ(caster.cast(down, kReach).material, Material::kAsphalt);
  EXPECT_FALSE(caster.cast(down, 4.9).is_hit());
}

TEST(RayCaster, NoRaySlipsBetweenNeighbours) {
  Mesh mesh;  // a plane of 1600 pieces
  for (int x = -20; x < 20; ++x) {
    for (int y = -20; y < 20; ++y) {
      mesh.add_quad(Vector3d(x, y, 0), Vector3d(x + 1, y, 0), Vector3d(x + 1, y + 1, 0),
                    Vector3d(x, y + 1, 0), Material::kGrass);
    }
  }
  const RayCaster caster(mesh);
  for (int x = -190; x < 190; ++x) {
    for (int y = -190; y < 190; y += 7) {
      const Ray ray{{0, 0, 3}, Vector3d(0.1 * x, 0.1 * y, -3).normalized()};
      EXPECT_NEAR(caster.cast(ray, kReach).distance_m, Vector3d(0.1 * x, 0.1 * y, 3).norm(), 1e-9);
    }
  }
}

TEST(Surroundings, AMoverIsMetWhereItIsAtThatMoment) {
  Place place;
  place.still.add_quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}, Material::kAsphalt);
  Mesh box;
  box.add_box(upright({0, 0, 0}, 0), {2, 2, 2}, Material::kPaint);
  place.shapes.push_back(box);
  place.movers.push_back({0, [](double t) { return upright({10 + 5 * t, 0, 0}, 0); }});
  const Surroundings surroundings(place);
  const Ray ahead{{0, 0, 1}, {1, 0, 0}};
  for (const double t : {0.0, 0.5, 2.0}) {
    const SurfaceHit hit = surroundings.cast(ahead, t, kReach);
    EXPECT_NEAR(hit.distance_m, 9 + 5 * t, 1e-9);
    EXPECT_EQ(hit.material, Material::kPaint);
  }
  EXPECT_FALSE(surroundings.cast({{0, 3, 1}, {1, 0, 0}}, 0, kReach).is_hit());
  EXPECT_EQ(surroundings.open_sky({0, 0, 1}), 1);
}

}  // namespace
}  // namespace traverse::simulation
