#pragma once

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"

namespace traverse::voxel_map {

using Matrix36 = Eigen::Matrix<double, 3, 6>;

/// A point that is deskewed by the motion that ends in the pose: with xi = Log(T_map_previous^-1 T)
/// and the share s = time / interval,
///     q_map = T Exp(s xi) p_lidar.
/// So the pose moves it twice. A body twist d of the pose, T Exp(d), moves the deskewed point as
///     d_point = (Ad(Exp(-s xi)) + s Jr(s xi) Jr^-1(xi)) d
/// moves it: dq/dd = R [-[p]x, I] d_point / d with the R and p of T Exp(s xi) and p_lidar.
/// docs/mathematics.md derives this and what evaluate() leaves out of it.
class SweptPoint {
 public:
  /// \param p_lidar metres, as measured  \param share s: 0 at the stamp of the pose
  SweptPoint(const geometry::Pose3& T_map_previous, const Eigen::Vector3d& p_lidar, double share)
      : T_previous_map_(T_map_previous.inverse()), p_lidar_(p_lidar), share_(share) {}

  Eigen::Vector3d at(const geometry::Pose3& T_map_lidar) const;

  /// dq/d[rotation (body, right), translation (map, additive)].
  Matrix36 derivative(const geometry::Pose3& T_map_lidar) const;

  const geometry::Pose3& T_previous_map() const { return T_previous_map_; }
  const Eigen::Vector3d& p_lidar() const { return p_lidar_; }
  double share() const { return share_; }

 private:
  geometry::Pose3 T_previous_map_;
  Eigen::Vector3d p_lidar_;
  double share_;
};

}  // namespace traverse::voxel_map
