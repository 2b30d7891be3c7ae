#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <ceres/sized_cost_function.h>

#include "traverse/geometry/so3.hpp"
#include "traverse/lidar/residuals.hpp"

#include "rotation_manifold.hpp"

namespace traverse::lidar {

/// A residual of the point q = R p + t, with analytic derivatives, for Ceres. Parameter blocks:
/// quaternion [x y z w] of R_map_lidar on RotationManifold, t_map_lidar [3]. The chain is
///     dr/dphi = dr/dq (-R [p]x),   dr/dt = dr/dq      (right perturbation; MATH "chain").
///
/// Residual is a type with kSize, Vector, Matrix (kSize x 3) and
/// Vector operator()(const Eigen::Vector3d& q, Matrix* dr_dq) const.
template <typename Residual>
class PointFactor final : public ceres::SizedCostFunction<Residual::kSize, 4, 3> {
 public:
  PointFactor(const Eigen::Vector3d& p_lidar, const Residual& residual)
      : p_lidar_(p_lidar), residual_(residual) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    constexpr int kSize = Residual::kSize;
    // Normalised here, because gradient checks step off the unit sphere.
    const Eigen::Quaterniond q = Eigen::Map<const Eigen::Quaterniond>(parameters[0]).normalized();
    const Eigen::Map<const Eigen::Vector3d> t(parameters[1]);
    const Eigen::Matrix3d R = q.toRotationMatrix();
    const Eigen::Vector3d p_map = R * p_lidar_ + t;

    typename Residual::Matrix dr_dq;
    Eigen::Map<typename Residual::Vector> r(residuals);
    r = residual_(p_map, jacobians == nullptr ? nullptr : &dr_dq);
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      const typename Residual::Matrix dr_dphi = -dr_dq * R * geometry::hat(p_lidar_);
      Eigen::Map<Eigen::Matrix<double, kSize, 4, Eigen::RowMajor>> dr_dquaternion(jacobians[0]);
      dr_dquaternion = 4 * dr_dphi * RotationManifold::plus_jacobian(q.coeffs().data()).transpose();
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, kSize, 3, Eigen::RowMajor>> dr_dt(jacobians[1]);
      dr_dt = dr_dq;
    }
    return true;
  }

 private:
  Eigen::Vector3d p_lidar_;
  Residual residual_;
};

struct LineVectorResidual {
  static constexpr int kSize = 3;
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;
  Line line;
  Vector operator()(const Eigen::Vector3d& q, Matrix* dr_dq) const {
    return line_vector_residual(line, q, dr_dq);
  }
};

struct LineDistanceResidual {
  static constexpr int kSize = 1;
  using Vector = Eigen::Matrix<double, 1, 1>;
  using Matrix = Eigen::RowVector3d;
  Line line;
  Vector operator()(const Eigen::Vector3d& q, Matrix* dr_dq) const {
    return Vector(line_distance_residual(line, q, dr_dq));
  }
};

struct PlaneResidual {
  static constexpr int kSize = 1;
  using Vector = Eigen::Matrix<double, 1, 1>;
  using Matrix = Eigen::RowVector3d;
  Plane plane;
  Vector operator()(const Eigen::Vector3d& q, Matrix* dr_dq) const {
    return Vector(plane_residual(plane, q, dr_dq));
  }
};

}  // namespace traverse::lidar
