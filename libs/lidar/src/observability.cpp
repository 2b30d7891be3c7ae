#include "traverse/lidar/observability.hpp"

#include <Eigen/Eigenvalues>

namespace traverse::lidar {

geometry::Twist Observability::well_observed(const geometry::Twist& twist) const {
  Vector6 scaled = twist;
  scaled.head<3>() *= rotation_scale_m;
  const Matrix6& V = directions;
  Vector6 coordinates = V.transpose() * scaled;
  coordinates.head(degenerate).setZero();
  Vector6 kept = V * coordinates;
  kept.head<3>() /= rotation_scale_m;
  return kept;
}

Observability observability(const Matrix6& information, double rotation_scale_m,
                            double min_eigenvalue) {
  Observability result;
  result.rotation_scale_m = rotation_scale_m;
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(information);
  result.eigenvalues = solver.eigenvalues();
  result.directions = solver.eigenvectors();
  result.degenerate = static_cast<int>((result.eigenvalues.array() < min_eigenvalue).count());
  return result;
}

}  // namespace traverse::lidar
