#include "traverse/voxel_map/row_factor_kinds.hpp"

#include <string>
#include <utility>

#include <ceres/autodiff_cost_function.h>

#include "swept_rows_factor.hpp"
#include "swept_rows_functor.hpp"

namespace traverse::voxel_map {

namespace {

using optimization::FactorKind;
using optimization::FactorSample;
using optimization::Perturbation;
using optimization::RandomStates;

constexpr const char* kPlaneRow = "voxel plane row";
constexpr const char* kLineRows = "voxel line rows";

/// Perpendicular planes, each half a metre to five metres from q.
template <int kRows>
PlanesOf<kRows> planes_away_from(const Eigen::Vector3d& q, RandomStates& random) {
  PlanesOf<kRows> planes;
  Eigen::Vector3d normal = random.unit_vector();
  for (int row = 0; row < kRows; ++row) {
    const double side = random.uniform(-1, 1) < 0 ? -1 : 1;
    planes.normals.row(row) = normal;
    planes.offsets[row] = side * random.uniform(0.5, 5) - normal.dot(q);
    normal = normal.cross(random.unit_vector()).normalized();
  }
  return planes;
}

/// Shares within half a sweep of the stamp; motions up to 5 m and nearly 30 degrees on each axis.
template <int kRows>
FactorSample sample(RandomStates& random, Perturbation) {
  const geometry::Pose3 T_map_previous =
      geometry::Pose3::from_quaternion(Eigen::Quaterniond(random.quaternion(3)), random.vector(10));
  geometry::Twist motion;
  motion << random.uniform(0.05, 0.5), random.vector(0.5).head<2>(), random.vector(5);
  const geometry::Pose3 pose = T_map_previous * geometry::exp_se3(motion);

  const SweptPoint point(T_map_previous, random.vector(20), random.uniform(-0.5, 0.5));
  const PlanesOf<kRows> planes = planes_away_from<kRows>(point.at(pose), random);
  const Eigen::Vector4d q = pose.quaternion().coeffs();
  using Functor = SweptRowsFunctor<kRows>;  // owned by Ceres' class
  return {std::make_shared<SweptRowsFactor<kRows>>(point, planes),
          std::make_shared<ceres::AutoDiffCostFunction<Functor, kRows, 4, 3>>(
              new Functor(point, planes)),
          {q, pose.translation}};
}

template <int kRows>
FactorKind kind(std::string name, std::string formula) {
  return {std::move(name),
          std::move(formula),
          {{"rotation", 4, true}, {"translation", 3, false}},
          {Perturbation::kRight},
          sample<kRows>};
}

}  // namespace

std::vector<FactorKind> row_factor_kinds() {
  const std::string point = ", q = T Exp(s Log(T₀⁻¹ T)) p";
  return {kind<1>(kPlaneRow, "r = n · q + d" + point),
          kind<2>(kLineRows, "r = [n₁ · q + d₁, n₂ · q + d₂]" + point)};
}

std::vector<optimization::FactorUse> row_factors() {
  return {{kPlaneRow, Perturbation::kRight}, {kLineRows, Perturbation::kRight}};
}

}  // namespace traverse::voxel_map
