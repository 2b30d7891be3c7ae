// Adds a residual that Traverse does not have, the range to a radio beacon, and has its analytic
// Jacobian audited as `traverse check-jacobians` audits Traverse's own: at random states away from
// zero residual, against dual numbers and against central differences.
//
//     r = (|p + R l - b| - d) / sigma
//
// p, R pose of the body in the map; l antenna in the body; b beacon in the map; d measured range.
//
// Try it: change a sign in BeaconCost::Evaluate, and the audit fails with the block that is wrong.
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <ceres/autodiff_cost_function.h>
#include <ceres/sized_cost_function.h>

#include "traverse/geometry/so3.hpp"
#include "traverse/optimization/jacobian_audit.hpp"
#include "traverse/optimization/rotation_manifold.hpp"

namespace {

using traverse::optimization::Perturbation;
using traverse::optimization::RotationManifold;

struct BeaconRange {
  Eigen::Vector3d antenna_body;
  Eigen::Vector3d beacon_map;
  double range_m;
  double sigma_m;
};

// The residual with the derivative that was found by hand: what a solver would use. A pose is two
// parameter blocks, a unit quaternion [x y z w] and a translation.
class BeaconCost final : public ceres::SizedCostFunction<1, 4, 3> {
 public:
  BeaconCost(const BeaconRange& measured, Perturbation perturbation)
      : measured_(measured), perturbation_(perturbation) {}

  bool Evaluate(double const* const* x, double* residual, double** jacobians) const override {
    const Eigen::Quaterniond q = Eigen::Map<const Eigen::Quaterniond>(x[0]).normalized();
    const Eigen::Map<const Eigen::Vector3d> p(x[1]);
    const Eigen::Vector3d arm_map = q * measured_.antenna_body;
    const Eigen::Vector3d from_beacon = p + arm_map - measured_.beacon_map;
    residual[0] = (from_beacon.norm() - measured_.range_m) / measured_.sigma_m;
    if (jacobians == nullptr) return true;

    const Eigen::RowVector3d direction = from_beacon.normalized().transpose() / measured_.sigma_m;
    if (jacobians[0] != nullptr) {
      // R Exp(d) l = R l - R (l x d) d;  Exp(d) R l = R l - (R l x) d.
      const Eigen::Matrix3d R = q.toRotationMatrix();
      const Eigen::Matrix3d dp_dd =
          perturbation_ == Perturbation::kRight
              ? Eigen::Matrix3d(-R * traverse::geometry::hat(measured_.antenna_body))
              : Eigen::Matrix3d(-traverse::geometry::hat(arm_map));
      const auto P = RotationManifold::plus_jacobian(x[0], perturbation_);
      Eigen::Map<Eigen::RowVector4d> by_rotation(jacobians[0]);
      by_rotation = direction * dp_dd * (4 * P.transpose());
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::RowVector3d> by_translation(jacobians[1]);
      by_translation = direction;
    }
    return true;
  }

 private:
  BeaconRange measured_;
  Perturbation perturbation_;
};

// The same from its definition alone, for any number type, so that Ceres' dual numbers derive it.
struct BeaconFunctor {
  BeaconRange measured;

  template <typename T>
  bool operator()(const T* rotation, const T* translation, T* residual) const {
    const Eigen::Quaternion<T> q = Eigen::Map<const Eigen::Quaternion<T>>(rotation).normalized();
    const Eigen::Matrix<T, 3, 1> arm = measured.antenna_body.cast<T>();
    const Eigen::Matrix<T, 3, 1> antenna =
        Eigen::Map<const Eigen::Matrix<T, 3, 1>>(translation) + q * arm;
    residual[0] = ((antenna - measured.beacon_map.cast<T>()).norm() - T(measured.range_m)) /
                  T(measured.sigma_m);
    return true;
  }
};

// What the audit is told: names for its table, and instances with states to look at.
traverse::optimization::FactorKind beacon_kind() {
  traverse::optimization::FactorKind kind;
  kind.name = "beacon range";
  kind.formula = "r = |p + R l - b| - d";
  kind.blocks = {{"rotation", 4, true}, {"translation", 3, false}};
  kind.perturbations = {Perturbation::kRight, Perturbation::kLeft};
  kind.make = [](traverse::optimization::RandomStates& random, Perturbation perturbation) {
    const BeaconRange measured{random.vector(2), random.vector(100), random.uniform(1, 50),
                               random.uniform(0.1, 2)};
    using Automatic = ceres::AutoDiffCostFunction<BeaconFunctor, 1, 4, 3>;
    return traverse::optimization::FactorSample{
        std::make_shared<BeaconCost>(measured, perturbation),
        std::make_shared<Automatic>(new BeaconFunctor{measured}),
        {random.quaternion(3), random.vector(100)}};
  };
  return kind;
}

}  // namespace

int main() {
  // In a program that runs pipelines, traverse::pipeline::register_factor_kinds() adds the kind to
  // those of Traverse: an odometry that names it in factors() then has it checked in every run.
  const std::vector kinds{beacon_kind()};
  const auto audit = traverse::optimization::audit_jacobians(kinds, {});
  for (const auto& factor : audit.factors) {
    for (const auto& block : factor.blocks) {
      std::printf(
          "%s, %s, %s perturbation: off by %.1e from dual numbers, %.1e from differences: %s\n",
          factor.factor.c_str(), block.block.c_str(), name_of(factor.perturbation).data(),
          block.automatic.relative, block.numeric.relative, block.passed ? "pass" : "FAIL");
    }
  }
  return audit.passed() ? EXIT_SUCCESS : EXIT_FAILURE;
}
