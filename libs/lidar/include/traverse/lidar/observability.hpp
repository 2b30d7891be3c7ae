#pragma once

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"

namespace traverse::lidar {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// How well the matches determine each direction of motion.
///
/// The information matrix is that of the body twist [rotation, translation] at the pose, with the
/// rotation multiplied by the median range of the matched points, so that all six axes are lengths
/// and their eigenvalues compare, and divided by the number of matches: an eigenvalue is the mean
/// squared share of a residual that a unit motion in its direction makes, between 0 and 1 for
/// translations. A match with a fraction below 1 counts with that part of the twist that moves its
/// point. (Zhang, Kaess and Singh, "On degeneracy of optimization-based state estimation
/// problems", ICRA 2016, compare raw eigenvalues, which grow with the number of points.)
struct Observability {
  Vector6 eigenvalues = Vector6::Zero();     ///< ascending
  Matrix6 directions = Matrix6::Identity();  ///< column k belongs to eigenvalue k; scaled axes
  double rotation_scale_m = 1;               ///< the median range
  int degenerate = 0;  ///< how many eigenvalues, from the first, are too small

  /// `twist` without its part along the degenerate directions: V diag(mask) V' in scaled axes.
  geometry::Twist well_observed(const geometry::Twist& twist) const;
};

/// From an information matrix in scaled axes that is already divided by its matches.
/// \param min_eigenvalue directions with a smaller eigenvalue are degenerate
Observability observability(const Matrix6& information, double rotation_scale_m,
                            double min_eigenvalue);

}  // namespace traverse::lidar
