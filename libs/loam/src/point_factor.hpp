#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <ceres/sized_cost_function.h>

#include "traverse/optimization/rotation_manifold.hpp"

#include "point_motion.hpp"

namespace traverse::loam {

/// A residual of the moved point q, with analytic derivatives, for Ceres. Parameter blocks:
/// quaternion [x y z w] of R_map_lidar on optimization::RotationManifold, t_map_lidar [3].
///
/// Residual is one of point_residuals.hpp. The Jacobian handed to Ceres is the ambient one, which
/// suits a manifold of either side; `motion` says through which side it is derived.
template <typename Residual>
class PointFactor final : public ceres::SizedCostFunction<Residual::kSize, 4, 3> {
 public:
  PointFactor(const PointMotion& motion, const Residual& residual)
      : motion_(motion), residual_(residual) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    using optimization::RotationManifold;
    constexpr int kSize = Residual::kSize;
    // Normalised here, because gradient checks step off the unit sphere.
    const Eigen::Quaterniond q = Eigen::Map<const Eigen::Quaterniond>(parameters[0]).normalized();
    const PointMotion::Moved moved =
        motion_.at(q, Eigen::Map<const Eigen::Vector3d>(parameters[1]));

    typename Residual::Matrix dr_dq;
    Eigen::Map<typename Residual::Vector> r(residuals);
    r = residual_(moved.q_map, jacobians == nullptr ? nullptr : &dr_dq);
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      const typename Residual::Matrix dr_dd = motion_.by_rotation(dr_dq, moved);
      const RotationManifold::PlusMatrix P =
          RotationManifold::plus_jacobian(q.coeffs().data(), motion_.perturbation());
      Eigen::Map<Eigen::Matrix<double, kSize, 4, Eigen::RowMajor>> dr_dquaternion(jacobians[0]);
      dr_dquaternion = 4 * dr_dd * P.transpose();
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, kSize, 3, Eigen::RowMajor>> dr_dt(jacobians[1]);
      dr_dt = motion_.by_translation(dr_dq);
    }
    return true;
  }

 private:
  PointMotion motion_;
  Residual residual_;
};

}  // namespace traverse::loam
