#include "residuals.hpp"

#include "traverse/geometry/so3.hpp"

namespace traverse::pose_graph {

using geometry::hat;
using geometry::Pose3;

Residual<6> between_residual(const Pose3& T_i_j_measured, const Pose3& T_map_i,
                             const Pose3& T_map_j, PoseJacobian<6>* dr_di, PoseJacobian<6>* dr_dj) {
  const Eigen::Matrix3d Ri_t = T_map_i.rotation.transpose();
  const Eigen::Vector3d p_i_j = Ri_t * (T_map_j.translation - T_map_i.translation);
  Residual<6> r;
  const Eigen::Vector3d r_R =
      geometry::log_so3(T_i_j_measured.rotation.transpose() * Ri_t * T_map_j.rotation);
  r.head<3>() = r_R;
  r.tail<3>() = p_i_j - T_i_j_measured.translation;
  if (dr_di == nullptr && dr_dj == nullptr) return r;

  const Eigen::Matrix3d Jr_inverse = geometry::right_jacobian_inverse(r_R);
  if (dr_di != nullptr) {
    dr_di->setZero();
    dr_di->topLeftCorner<3, 3>() = -Jr_inverse * T_map_j.rotation.transpose() * T_map_i.rotation;
    dr_di->bottomLeftCorner<3, 3>() = hat(p_i_j);
    dr_di->bottomRightCorner<3, 3>() = -Ri_t;
  }
  if (dr_dj != nullptr) {
    dr_dj->setZero();
    dr_dj->topLeftCorner<3, 3>() = Jr_inverse;
    dr_dj->bottomRightCorner<3, 3>() = Ri_t;
  }
  return r;
}

Residual<3> antenna_residual(const Eigen::Vector3d& antenna_map_measured,
                             const Eigen::Vector3d& antenna_body, const Pose3& T_map_body,
                             PoseJacobian<3>* dr_dx) {
  if (dr_dx != nullptr) {
    dr_dx->leftCols<3>() = -T_map_body.rotation * hat(antenna_body);
    dr_dx->rightCols<3>().setIdentity();
  }
  return T_map_body * antenna_body - antenna_map_measured;
}

Residual<3> gravity_residual(const Eigen::Vector3d& up_body_measured, const Pose3& T_map_body,
                             const Eigen::Vector3d& up_map, const Eigen::Vector3d& offset_body,
                             PoseJacobian<3>* dr_dx, Eigen::Matrix3d* dr_dup) {
  const Eigen::Vector3d up_body = T_map_body.rotation.transpose() * up_map;
  if (dr_dx != nullptr) {
    dr_dx->leftCols<3>() = hat(up_body);
    dr_dx->rightCols<3>().setZero();
  }
  if (dr_dup != nullptr) *dr_dup = T_map_body.rotation.transpose();
  return up_body + offset_body - up_body_measured;
}

}  // namespace traverse::pose_graph
