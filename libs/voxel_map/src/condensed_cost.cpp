#include "condensed_cost.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include "traverse/optimization/rotation_manifold.hpp"

namespace traverse::voxel_map {

const NormalEquations& CondensedCost::at(const geometry::Pose3& T_map_lidar) const {
  const bool same = known_ && last_pose_.rotation == T_map_lidar.rotation &&
                    last_pose_.translation == T_map_lidar.translation;
  if (!same) {
    last_ = evaluate(matches_, motion_, T_map_lidar, options_, workers_);
    last_pose_ = T_map_lidar;
    known_ = true;
  }
  return last_;
}

bool CondensedCost::Evaluate(double const* const* parameters, double* residuals,
                             double** jacobians) const {
  // Normalised here, because gradient checks step off the unit sphere.
  const Eigen::Quaterniond q = Eigen::Map<const Eigen::Quaterniond>(parameters[0]).normalized();
  const geometry::Pose3 pose{q.toRotationMatrix(),
                             Eigen::Map<const Eigen::Vector3d>(parameters[1])};
  const NormalEquations& normal = at(pose);

  // A little is added to H, so that a motion that the matches do not see at all leaves a factor.
  const lidar::Matrix6 H = normal.H + 1e-9 * normal.H.trace() * lidar::Matrix6::Identity();
  const Eigen::LLT<lidar::Matrix6> llt(H);
  if (llt.info() != Eigen::Success) return false;
  Eigen::Map<Eigen::Matrix<double, 7, 1>> r(residuals);
  r.head<6>() = llt.matrixL().solve(normal.g);
  r[6] = std::sqrt(std::max(0.0, 2 * normal.cost - r.head<6>().squaredNorm()));
  if (jacobians == nullptr) return true;

  const lidar::Matrix6 Lt = llt.matrixU();
  if (jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 7, 4, Eigen::RowMajor>> J(jacobians[0]);
    J.setZero();
    J.topRows<6>() = 4 * Lt.leftCols<3>() *
                     optimization::RotationManifold::plus_jacobian(
                         q.coeffs().data(), optimization::Perturbation::kRight)
                         .transpose();
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 7, 3, Eigen::RowMajor>> J(jacobians[1]);
    J.setZero();
    J.topRows<6>() = Lt.rightCols<3>();
  }
  return true;
}

}  // namespace traverse::voxel_map
