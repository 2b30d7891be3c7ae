#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <ceres/sized_cost_function.h>

#include "traverse/geometry/se3.hpp"
#include "traverse/optimization/rotation_manifold.hpp"

#include "residuals.hpp"

/// The residuals as Ceres' cost functions, in units of their standard deviation. A pose is two
/// parameter blocks, a unit quaternion [x y z w] and a translation.
namespace traverse::pose_graph {

/// The W for which |W r|^2 = r' covariance^-1 r.
template <int N>
Eigen::Matrix<double, N, N> square_root_information(const Eigen::Matrix<double, N, N>& covariance) {
  using Matrix = Eigen::Matrix<double, N, N>;
  Matrix W = Matrix::Identity();
  Eigen::LLT<Matrix>(covariance).matrixL().solveInPlace(W);
  return W;
}

/// Through the normalised quaternion, so that derivatives off the sphere are those of the factor.
inline geometry::Pose3 pose_of(const double* rotation, const double* translation) {
  return geometry::Pose3::from_quaternion(Eigen::Map<const Eigen::Quaterniond>(rotation),
                                          Eigen::Map<const Eigen::Vector3d>(translation));
}

/// Writes the derivative by a pose, dr_dx, into Jacobians of its two blocks; either may be null.
template <int N>
void write_jacobians(const PoseJacobian<N>& dr_dx, const double* rotation, double* by_rotation,
                     double* by_translation) {
  using optimization::Perturbation;
  using optimization::RotationManifold;
  if (by_rotation != nullptr) {
    const auto P = RotationManifold::plus_jacobian(rotation, Perturbation::kRight);
    Eigen::Map<Eigen::Matrix<double, N, 4, Eigen::RowMajor>> ambient(by_rotation);
    ambient.noalias() = dr_dx.template leftCols<3>() * (4 * P.transpose());
  }
  if (by_translation != nullptr) {
    Eigen::Map<Eigen::Matrix<double, N, 3, Eigen::RowMajor>> ambient(by_translation);
    ambient = dr_dx.template rightCols<3>();
  }
}

class BetweenCost final : public ceres::SizedCostFunction<6, 4, 3, 4, 3> {
 public:
  BetweenCost(const geometry::Pose3& T_i_j, const geometry::Matrix6& square_root_information)
      : T_i_j_(T_i_j), W_(square_root_information) {}

  bool Evaluate(double const* const* x, double* r, double** jacobians) const override {
    PoseJacobian<6> dr_di, dr_dj;
    const bool derive = jacobians != nullptr;
    Eigen::Map<Residual<6>> residual(r);
    residual = W_ * between_residual(T_i_j_, pose_of(x[0], x[1]), pose_of(x[2], x[3]),
                                     derive ? &dr_di : nullptr, derive ? &dr_dj : nullptr);
    if (!derive) return true;
    write_jacobians<6>(W_ * dr_di, x[0], jacobians[0], jacobians[1]);
    write_jacobians<6>(W_ * dr_dj, x[2], jacobians[2], jacobians[3]);
    return true;
  }

 private:
  geometry::Pose3 T_i_j_;
  geometry::Matrix6 W_;
};

class AntennaCost final : public ceres::SizedCostFunction<3, 4, 3> {
 public:
  AntennaCost(const Eigen::Vector3d& antenna_map, const Eigen::Vector3d& antenna_body,
              const Eigen::Matrix3d& square_root_information)
      : antenna_map_(antenna_map), antenna_body_(antenna_body), W_(square_root_information) {}

  bool Evaluate(double const* const* x, double* r, double** jacobians) const override {
    PoseJacobian<3> dr_dx;
    Eigen::Map<Residual<3>> residual(r);
    residual = W_ * antenna_residual(antenna_map_, antenna_body_, pose_of(x[0], x[1]),
                                     jacobians != nullptr ? &dr_dx : nullptr);
    if (jacobians != nullptr) {
      write_jacobians<3>(W_ * dr_dx, x[0], jacobians[0], jacobians[1]);
    }
    return true;
  }

 private:
  Eigen::Vector3d antenna_map_, antenna_body_;
  Eigen::Matrix3d W_;
};

/// Blocks: rotation of the body, direction of up in the map, offset of the instrument.
class GravityCost final : public ceres::SizedCostFunction<3, 4, 3, 3> {
 public:
  GravityCost(const Eigen::Vector3d& up_body, double sigma)
      : up_body_(up_body), weight_(1 / sigma) {}

  bool Evaluate(double const* const* x, double* r, double** jacobians) const override {
    static constexpr double kNowhere[3] = {0, 0, 0};  // a direction does not know the position
    const Eigen::Map<const Eigen::Vector3d> up_map(x[1]);
    const Eigen::Map<const Eigen::Vector3d> offset(x[2]);
    PoseJacobian<3> dr_dx;
    Eigen::Matrix3d dr_dup;
    const bool derive = jacobians != nullptr;
    Eigen::Map<Residual<3>> residual(r);
    residual = weight_ * gravity_residual(up_body_, pose_of(x[0], kNowhere), up_map, offset,
                                          derive ? &dr_dx : nullptr, derive ? &dr_dup : nullptr);
    if (!derive) return true;
    write_jacobians<3>(weight_ * dr_dx, x[0], jacobians[0], nullptr);
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> by_up(jacobians[1]);
      by_up = weight_ * dr_dup;
    }
    if (jacobians[2] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> by_offset(jacobians[2]);
      by_offset = weight_ * Eigen::Matrix3d::Identity();
    }
    return true;
  }

 private:
  Eigen::Vector3d up_body_;
  double weight_;
};

}  // namespace traverse::pose_graph
