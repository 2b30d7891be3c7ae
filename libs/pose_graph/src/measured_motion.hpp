#pragma once

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/se3.hpp"

namespace traverse::pose_graph {

/// A motion and how far it may be off: the covariance of (rotation on the right of T_i_j [rad, axes
/// of j], translation [m, axes of i]), as PoseGraph::add_between takes it.
struct MeasuredMotion {
  geometry::Pose3 T_i_j;
  geometry::Matrix6 covariance = geometry::Matrix6::Zero();

  MeasuredMotion inverse() const;
  /// Of the body twist (rotation, translation), in the axes of j.
  geometry::Matrix6 twist_covariance() const;
};

/// T_i_k = T_i_j T_j_k of independent measurements, to the first order of their errors.
MeasuredMotion operator*(const MeasuredMotion& i_j, const MeasuredMotion& j_k);

}  // namespace traverse::pose_graph
