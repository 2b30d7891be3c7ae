#pragma once

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"

/// What a pose graph makes small, each one pure function of the poses with its derivative in their
/// tangent on request. None is divided by its standard deviation yet.
///
/// The tangent of a pose T_map_body is (rotation vector on the right [rad], shift in the map [m]).
/// Source of the formulas: docs/mathematics-pose-graph.md, where they are derived.
namespace traverse::pose_graph {

template <int N>
using Residual = Eigen::Matrix<double, N, 1>;
template <int N>
using PoseJacobian = Eigen::Matrix<double, N, 6>;

/// The motion from i to j less the one that was measured:
///     (Log(R_m' R_i' R_j), R_i' (p_j - p_i) - p_m)     [rad, axes of j; m, axes of i].
Residual<6> between_residual(const geometry::Pose3& T_i_j_measured, const geometry::Pose3& T_map_i,
                             const geometry::Pose3& T_map_j, PoseJacobian<6>* dr_di = nullptr,
                             PoseJacobian<6>* dr_dj = nullptr);

/// Where the antenna is less where it was measured: p + R l - z [m, axes of the map].
/// \param antenna_body the lever arm l, body frame [m]
Residual<3> antenna_residual(const Eigen::Vector3d& antenna_map_measured,
                             const Eigen::Vector3d& antenna_body, const geometry::Pose3& T_map_body,
                             PoseJacobian<3>* dr_dx = nullptr);

/// Where up is, seen from the body with an instrument that is off by b, less where it was measured:
/// R' u + b - u_m. Its norm is the chord of the angle between the two [rad, for small ones]. The
/// derivative by b is the identity. \param up_map, up_body_measured unit vectors
/// \param offset_body b: an accelerometer's bias in units of gravity, and how it is mounted
Residual<3> gravity_residual(const Eigen::Vector3d& up_body_measured,
                             const geometry::Pose3& T_map_body, const Eigen::Vector3d& up_map,
                             const Eigen::Vector3d& offset_body, PoseJacobian<3>* dr_dx = nullptr,
                             Eigen::Matrix3d* dr_dup = nullptr);

}  // namespace traverse::pose_graph
