#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "point_residuals.hpp"

namespace traverse::loam {

/// Exp(s Log q) of a unit quaternion, the short way round, for numbers of any type:
/// [sin(s a)/sin(a) v, cos(s a)] with the vector part v of q and its half angle a.
template <typename T>
Eigen::Quaternion<T> part_of_rotation(const Eigen::Quaternion<T>& q, double s) {
  using std::atan2;
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T sign = q.w() < T(0) ? T(-1) : T(1);
  const Vector3<T> v = sign * q.vec();
  const T squared_sine = v.squaredNorm();
  T ratio;
  T cosine;
  if (squared_sine < T(1e-8)) {  // series: the root has no derivative at zero
    ratio = T(s) * (T(1) + T((1 - s * s) / 6) * squared_sine);
    cosine = T(1) - T(s * s / 2) * squared_sine;
  } else {
    const T sine = sqrt(squared_sine);
    const T half_angle = atan2(sine, sign * q.w());
    ratio = sin(T(s) * half_angle) / sine;
    cosine = cos(T(s) * half_angle);
  }
  const Vector3<T> part = ratio * v;
  return Eigen::Quaternion<T>(cosine, part.x(), part.y(), part.z());
}

/// The same residual as PointFactor's as a plain formula of the pose's quaternion [x y z w] and
/// translation, of which Ceres makes automatic or numeric derivatives.
template <typename Residual>
class PointFunctor {
 public:
  PointFunctor(const Eigen::Vector3d& p_lidar, double fraction, const Residual& residual)
      : p_lidar_(p_lidar), fraction_(fraction), residual_(residual) {}

  template <typename T>
  bool operator()(const T* quaternion, const T* translation, T* r) const {
    Eigen::Quaternion<T> q = Eigen::Map<const Eigen::Quaternion<T>>(quaternion).normalized();
    Vector3<T> t = Eigen::Map<const Vector3<T>>(translation);
    if (fraction_ != 1) {
      q = part_of_rotation(q, fraction_);
      t *= T(fraction_);
    }
    const Vector3<T> q_map = q * p_lidar_.cast<T>() + t;
    residual_.formula(q_map, r);
    return true;
  }

 private:
  Eigen::Vector3d p_lidar_;
  double fraction_;
  Residual residual_;
};

}  // namespace traverse::loam
