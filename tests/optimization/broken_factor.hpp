#pragma once

#include <Eigen/Geometry>
#include <ceres/autodiff_cost_function.h>
#include <ceres/sized_cost_function.h>

#include "traverse/geometry/so3.hpp"
#include "traverse/optimization/factor_kind.hpp"
#include "traverse/optimization/rotation_manifold.hpp"

namespace traverse::testing {

/// r = R p - z with the Jacobian -[R p]x of a left perturbation.
class TurnedPoint final : public ceres::SizedCostFunction<3, 4> {
 public:
  TurnedPoint(const Eigen::Vector3d& p, const Eigen::Vector3d& z,
              optimization::Perturbation taken_for)
      : p_(p), z_(z), taken_for_(taken_for) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Quaterniond q = Eigen::Map<const Eigen::Quaterniond>(parameters[0]).normalized();
    const Eigen::Vector3d turned = q * p_;
    Eigen::Map<Eigen::Vector3d> r(residuals);
    r = turned - z_;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      const auto P = optimization::RotationManifold::plus_jacobian(q.coeffs().data(), taken_for_);
      Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> J(jacobians[0]);
      J = -4 * geometry::hat(turned) * P.transpose();
    }
    return true;
  }

 private:
  Eigen::Vector3d p_;
  Eigen::Vector3d z_;
  optimization::Perturbation taken_for_;
};

struct TurnedPointFormula {
  Eigen::Vector3d p;
  Eigen::Vector3d z;

  template <typename T>
  bool operator()(const T* quaternion, T* residuals) const {
    const Eigen::Quaternion<T> q = Eigen::Map<const Eigen::Quaternion<T>>(quaternion).normalized();
    Eigen::Map<Eigen::Matrix<T, 3, 1>> r(residuals);
    r = q * p.cast<T>() - z.cast<T>();
    return true;
  }
};

/// A factor whose Jacobian is derived for the left: right when `perturbation` is the left one,
/// broken when a right one takes it.
inline optimization::FactorKind turned_point_kind(optimization::Perturbation perturbation) {
  return {"turned point",
          "r = R p - z",
          {{"rotation", 4, true}},
          {perturbation},
          [](optimization::RandomStates& random, optimization::Perturbation taken_for) {
            const Eigen::Vector3d p = random.vector(10);
            const Eigen::Vector3d z = random.vector(10);
            return optimization::FactorSample{
                std::make_shared<TurnedPoint>(p, z, taken_for),
                std::make_shared<ceres::AutoDiffCostFunction<TurnedPointFormula, 3, 4>>(
                    new TurnedPointFormula{p, z}),
                {random.quaternion(3)}};
          }};
}

}  // namespace traverse::testing
