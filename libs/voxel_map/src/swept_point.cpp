#include "swept_point.hpp"

#include <Eigen/LU>

#include "traverse/geometry/se3.hpp"
#include "traverse/geometry/so3.hpp"

namespace traverse::voxel_map {

Eigen::Vector3d SweptPoint::at(const geometry::Pose3& T_map_lidar) const {
  const geometry::Twist xi = geometry::log_se3(T_previous_map_ * T_map_lidar);
  return T_map_lidar * geometry::exp_se3(share_ * xi) * p_lidar_;
}

Matrix36 SweptPoint::derivative(const geometry::Pose3& T_map_lidar) const {
  using geometry::Matrix6;
  const geometry::Twist xi = geometry::log_se3(T_previous_map_ * T_map_lidar);
  const geometry::Twist part = share_ * xi;
  const Matrix6 d_point =
      geometry::adjoint(geometry::exp_se3(-part)) +
      share_ * geometry::right_jacobian_se3(part) * geometry::right_jacobian_se3(xi).inverse();
  Matrix36 dq;
  dq << -geometry::hat(p_lidar_), Eigen::Matrix3d::Identity();
  dq = T_map_lidar.rotation * geometry::exp_se3(part).rotation * dq * d_point;
  // A translation tau in the map is the body twist (0, R' tau).
  dq.rightCols<3>() *= T_map_lidar.rotation.transpose();
  return dq;
}

}  // namespace traverse::voxel_map
