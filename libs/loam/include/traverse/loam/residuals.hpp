#pragma once

#include <Eigen/Core>

/// The distances that lidar registration makes small, each one pure function of the point q in the
/// map frame, with its derivative in q on request. Source: Zhang and Singh, LOAM (RSS 2014), eqs.
/// 2-3; Wang et al., F-LOAM (IROS 2021), eqs. 9-12.
namespace traverse::loam {

/// A straight line in the map frame: any point of it and its direction.
struct Line {
  Eigen::Vector3d point;      ///< metres
  Eigen::Vector3d direction;  ///< unit
};

/// A plane in the map frame: normal . q + offset = 0.
struct Plane {
  Eigen::Vector3d normal;  ///< unit
  double offset;           ///< metres
};

/// r = u x (q - c), [3] metres: smooth everywhere, of rank 2. dr/dq = [u]x.
Eigen::Vector3d line_vector_residual(const Line& line, const Eigen::Vector3d& q,
                                     Eigen::Matrix3d* dr_dq = nullptr);

/// Closer than this to a line a point counts as on it.
inline constexpr double kOnTheLine_m = 1e-9;

/// r = |u x (q - c)|, metres. dr/dq = (u x (q - c))' [u]x / r, of rank 1; on the line itself, where
/// the derivative does not exist, it is set to zero (a stationary point of the cost r^2).
double line_distance_residual(const Line& line, const Eigen::Vector3d& q,
                              Eigen::RowVector3d* dr_dq = nullptr);

/// r = n . q + d, metres, signed. dr/dq = n'.
double plane_residual(const Plane& plane, const Eigen::Vector3d& q,
                      Eigen::RowVector3d* dr_dq = nullptr);

/// r = |n . q + d|, metres. dr/dq = sign(n . q + d) n', with sign(0) = 1: r^2, r dr/dq and the
/// outer product of dr/dq are those of the signed residual, so least squares takes the same steps.
double plane_distance_residual(const Plane& plane, const Eigen::Vector3d& q,
                               Eigen::RowVector3d* dr_dq = nullptr);

}  // namespace traverse::loam
