#include "traverse/loam/residuals.hpp"

#include <Eigen/Geometry>

#include "traverse/geometry/so3.hpp"

namespace traverse::loam {

Eigen::Vector3d line_vector_residual(const Line& line, const Eigen::Vector3d& q,
                                     Eigen::Matrix3d* dr_dq) {
  if (dr_dq != nullptr) *dr_dq = geometry::hat(line.direction);
  return line.direction.cross(q - line.point);
}

double line_distance_residual(const Line& line, const Eigen::Vector3d& q,
                              Eigen::RowVector3d* dr_dq) {
  const Eigen::Vector3d offset = line.direction.cross(q - line.point);
  const double distance = offset.norm();
  if (dr_dq != nullptr) {
    if (distance < kOnTheLine_m) {
      dr_dq->setZero();
    } else {
      *dr_dq = offset.cross(line.direction).transpose() / distance;  // o' [u]x = (o x u)'
    }
  }
  return distance;
}

double plane_residual(const Plane& plane, const Eigen::Vector3d& q, Eigen::RowVector3d* dr_dq) {
  if (dr_dq != nullptr) *dr_dq = plane.normal.transpose();
  return plane.normal.dot(q) + plane.offset;
}

double plane_distance_residual(const Plane& plane, const Eigen::Vector3d& q,
                               Eigen::RowVector3d* dr_dq) {
  const double signed_distance = plane_residual(plane, q, dr_dq);
  if (signed_distance >= 0) return signed_distance;
  if (dr_dq != nullptr) *dr_dq = -*dr_dq;
  return -signed_distance;
}

}  // namespace traverse::loam
