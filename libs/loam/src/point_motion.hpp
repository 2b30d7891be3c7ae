#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/so3.hpp"
#include "traverse/optimization/perturbation.hpp"

namespace traverse::loam {

/// The share s of a motion T = [R t]: R_s = Exp(s Log R), s t. T itself for s = 1, none for s = 0.
/// The rotation goes the short way, so it jumps where the angle of R passes pi.
geometry::Pose3 part_of(const geometry::Pose3& T, double fraction);

/// How a pose [R t] moves a point p of the sweep, q = R_s p + s t, with the derivatives of q in a
/// small rotation vector d of R on the chosen side and in t. s is the share of the sweep's motion
/// that the point has seen (Zhang and Singh, LOAM, RSS 2014, eq. 4): 1 when the points stand where
/// they were at the pose's own moment. With the rotation vector phi = Log R:
///
///     s = 1, right:  dq/dd = -R [p]x              left:  dq/dd = -[R p]x
///     any s, right:  dq/dd = -R_s [p]x s Jr(s phi) Jr^-1(phi)
///            left:   dq/dd = -[R_s p]x s Jl(s phi) Jl^-1(phi)
///     either:        dq/dt = s I
///
/// docs/mathematics.md derives them.
class PointMotion {
 public:
  using Perturbation = optimization::Perturbation;

  /// \param p_lidar metres  \param fraction s
  PointMotion(const Eigen::Vector3d& p_lidar, double fraction, Perturbation perturbation)
      : p_lidar_(p_lidar), fraction_(fraction), perturbation_(perturbation) {}

  /// The moved point, and what its derivatives need of the pose.
  struct Moved {
    Eigen::Vector3d q_map;
    Eigen::Matrix3d R_s;
    Eigen::Vector3d phi;  ///< Log R; unset for s = 1, which does not need it
  };
  Moved at(const Eigen::Quaterniond& q_map_lidar, const Eigen::Vector3d& t_map_lidar) const {
    Moved moved;
    if (fraction_ == 1) {
      moved.R_s = q_map_lidar.toRotationMatrix();
      moved.q_map = moved.R_s * p_lidar_ + t_map_lidar;
    } else {
      moved.phi = geometry::log_quaternion(q_map_lidar);
      moved.R_s = geometry::exp_so3(fraction_ * moved.phi);
      moved.q_map = moved.R_s * p_lidar_ + fraction_ * t_map_lidar;
    }
    return moved;
  }

  /// dr/dd [rows x 3] from dr/dq [rows x 3]. The products are taken from the left, where a scalar
  /// residual has one row.
  template <typename Matrix>
  Matrix by_rotation(const Matrix& dr_dq, const Moved& moved) const {
    const bool right = perturbation_ == Perturbation::kRight;
    if (fraction_ == 1) {
      if (right) return -dr_dq * moved.R_s * geometry::hat(p_lidar_);
      return -dr_dq * geometry::hat(moved.R_s * p_lidar_);
    }
    const Eigen::Vector3d part = fraction_ * moved.phi;
    if (right) {
      return -dr_dq * moved.R_s * geometry::hat(p_lidar_) *
             (fraction_ * geometry::right_jacobian(part) *
              geometry::right_jacobian_inverse(moved.phi));
    }
    return -dr_dq * geometry::hat(moved.R_s * p_lidar_) *
           (fraction_ * geometry::left_jacobian(part) * geometry::left_jacobian_inverse(moved.phi));
  }

  /// dr/dt [rows x 3] from dr/dq [rows x 3].
  template <typename Matrix>
  Matrix by_translation(const Matrix& dr_dq) const {
    if (fraction_ == 1) return dr_dq;
    return fraction_ * dr_dq;
  }

  Perturbation perturbation() const { return perturbation_; }
  double fraction() const { return fraction_; }
  const Eigen::Vector3d& p_lidar() const { return p_lidar_; }

 private:
  Eigen::Vector3d p_lidar_;
  double fraction_;
  Perturbation perturbation_;
};

}  // namespace traverse::loam
