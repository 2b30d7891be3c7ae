#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <ceres/sized_cost_function.h>

#include "traverse/optimization/rotation_manifold.hpp"

#include "swept_point.hpp"

namespace traverse::voxel_map {

/// `kRows` planes through which a swept point should go, r = N q + d: one for a match with a plane,
/// the two that meet in the line for a match with a line.
template <int kRows>
struct PlanesOf {
  Eigen::Matrix<double, kRows, 3> normals;
  Eigen::Matrix<double, kRows, 1> offsets;
};

/// The rows of one match with their exact derivatives, for Ceres. Blocks: quaternion [x y z w] of
/// R_map_lidar on optimization::RotationManifold, t_map_lidar [3]. The odometry sums such rows
/// without making factors of them (scan_objective.hpp).
template <int kRows>
class SweptRowsFactor final : public ceres::SizedCostFunction<kRows, 4, 3> {
 public:
  SweptRowsFactor(const SweptPoint& point, const PlanesOf<kRows>& planes)
      : point_(point), planes_(planes) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    using optimization::RotationManifold;
    // Normalised here, because gradient checks step off the unit sphere.
    const Eigen::Quaterniond q = Eigen::Map<const Eigen::Quaterniond>(parameters[0]).normalized();
    const geometry::Pose3 pose{q.toRotationMatrix(),
                               Eigen::Map<const Eigen::Vector3d>(parameters[1])};
    Eigen::Map<Eigen::Matrix<double, kRows, 1>> r(residuals);
    r = planes_.normals * point_.at(pose) + planes_.offsets;
    if (jacobians == nullptr) return true;
    const Eigen::Matrix<double, kRows, 6> J = planes_.normals * point_.derivative(pose);
    if (jacobians[0] != nullptr) {
      const RotationManifold::PlusMatrix P =
          RotationManifold::plus_jacobian(q.coeffs().data(), optimization::Perturbation::kRight);
      Eigen::Map<Eigen::Matrix<double, kRows, 4, Eigen::RowMajor>> J_quaternion(jacobians[0]);
      J_quaternion = 4 * J.template leftCols<3>() * P.transpose();
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, kRows, 3, Eigen::RowMajor>> J_t(jacobians[1]);
      J_t = J.template rightCols<3>();
    }
    return true;
  }

 private:
  SweptPoint point_;
  PlanesOf<kRows> planes_;
};

}  // namespace traverse::voxel_map
