#pragma once

#include <Eigen/Core>

#include "traverse/loam/residuals.hpp"

namespace traverse::loam {

/// The residuals as types for PointFactor and PointFunctor. Each has kSize, Vector [kSize],
/// Matrix [kSize x 3], the value with its derivative dr/dq, which forwards to residuals.hpp, and
/// the bare formula for numbers of any type, from which automatic derivatives are made.
template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

struct LineVectorResidual {
  static constexpr int kSize = 3;
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;
  Line line;

  Vector operator()(const Eigen::Vector3d& q, Matrix* dr_dq) const {
    return line_vector_residual(line, q, dr_dq);
  }
  template <typename T>
  void formula(const Vector3<T>& q, T* r) const {
    const Vector3<T> from_line = q - line.point.cast<T>();
    Eigen::Map<Vector3<T>> result(r);
    result = line.direction.cast<T>().cross(from_line);
  }
};

struct LineDistanceResidual {
  static constexpr int kSize = 1;
  using Vector = Eigen::Matrix<double, 1, 1>;
  using Matrix = Eigen::RowVector3d;
  Line line;

  Vector operator()(const Eigen::Vector3d& q, Matrix* dr_dq) const {
    return Vector(line_distance_residual(line, q, dr_dq));
  }
  template <typename T>
  void formula(const Vector3<T>& q, T* r) const {
    using std::sqrt;
    const Vector3<T> from_line = q - line.point.cast<T>();
    const T squared = line.direction.cast<T>().cross(from_line).squaredNorm();
    // A constant, so with no derivative, where the root has none.
    r[0] = squared < T(kOnTheLine_m * kOnTheLine_m) ? T(0) : sqrt(squared);
  }
};

struct PlaneResidual {
  static constexpr int kSize = 1;
  using Vector = Eigen::Matrix<double, 1, 1>;
  using Matrix = Eigen::RowVector3d;
  Plane plane;

  Vector operator()(const Eigen::Vector3d& q, Matrix* dr_dq) const {
    return Vector(plane_residual(plane, q, dr_dq));
  }
  template <typename T>
  void formula(const Vector3<T>& q, T* r) const {
    r[0] = plane.normal.cast<T>().dot(q) + T(plane.offset);
  }
};

struct PlaneDistanceResidual {
  static constexpr int kSize = 1;
  using Vector = Eigen::Matrix<double, 1, 1>;
  using Matrix = Eigen::RowVector3d;
  Plane plane;

  Vector operator()(const Eigen::Vector3d& q, Matrix* dr_dq) const {
    return Vector(plane_distance_residual(plane, q, dr_dq));
  }
  template <typename T>
  void formula(const Vector3<T>& q, T* r) const {
    const T signed_distance = plane.normal.cast<T>().dot(q) + T(plane.offset);
    r[0] = signed_distance < T(0) ? -signed_distance : signed_distance;
  }
};

}  // namespace traverse::loam
