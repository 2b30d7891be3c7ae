#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swept_rows_factor.hpp"

namespace traverse::voxel_map {

/// The residual of SweptRowsFactor as a plain formula, for numbers of any type. Not for a motion
/// without a turn, where the angle is a root of zero.
template <int kRows>
class SweptRowsFunctor {
 public:
  SweptRowsFunctor(const SweptPoint& point, const PlanesOf<kRows>& planes)
      : point_(point), planes_(planes) {}

  template <typename T>
  bool operator()(const T* quaternion, const T* translation, T* residuals) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Eigen::Quaternion<T> q = Eigen::Map<const Eigen::Quaternion<T>>(quaternion).normalized();
    const Vector t = Eigen::Map<const Vector>(translation);

    // The motion [q_motion, t_motion] from the previous pose, its angle and axis.
    const geometry::Pose3& T_previous_map = point_.T_previous_map();
    const Eigen::Quaternion<T> q_motion = T_previous_map.quaternion().cast<T>() * q;
    const Vector t_motion =
        T_previous_map.rotation.cast<T>() * t + T_previous_map.translation.cast<T>();
    using std::atan2;
    using std::sqrt;
    const T sign = q_motion.w() < T(0) ? T(-1) : T(1);
    const T sine = sqrt(q_motion.vec().squaredNorm());
    const T angle = T(2) * atan2(sine, sign * q_motion.w());
    const Vector axis = q_motion.vec() * (sign / sine);

    // It is a screw: along the axis all shares are alike, across it the path is an arc. The chord
    // of a share is the chord of the whole, scaled and turned back by half of what is missing.
    const T share(point_.share());
    const Vector along = axis * axis.dot(t_motion);
    using std::sin;
    const T scale = sin(share * angle / T(2)) / sin(angle / T(2));
    const Vector chord = turned(axis, (share - T(1)) * angle / T(2), (t_motion - along).eval());
    const Vector deskewed =
        turned(axis, share * angle, point_.p_lidar().template cast<T>().eval()) + share * along +
        scale * chord;

    Eigen::Map<Eigen::Matrix<T, kRows, 1>> r(residuals);
    r = planes_.normals.template cast<T>() * (q * deskewed + t) +
        planes_.offsets.template cast<T>();
    return true;
  }

 private:
  /// Rodrigues' formula.
  template <typename T>
  static Eigen::Matrix<T, 3, 1> turned(const Eigen::Matrix<T, 3, 1>& axis, const T& angle,
                                       const Eigen::Matrix<T, 3, 1>& v) {
    using std::cos;
    using std::sin;
    return v * cos(angle) + axis.cross(v) * sin(angle) + axis * (axis.dot(v) * (T(1) - cos(angle)));
  }

  SweptPoint point_;
  PlanesOf<kRows> planes_;
};

}  // namespace traverse::voxel_map
