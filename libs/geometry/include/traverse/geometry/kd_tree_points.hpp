#pragma once

#include <cstddef>

#include <Eigen/Core>

namespace traverse::geometry {

/// Points as nanoflann's k-d trees read them: what they call a data set adaptor.
/// \tparam Points  a range of vectors, such as std::span<const Eigen::Vector3d>; or a type with
///     size() and coordinate(i, axis), where points are stored otherwise
template <typename Points>
struct KdTreePoints {
  Points points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  auto kdtree_get_pt(std::size_t i, std::size_t axis) const {
    if constexpr (requires { points.coordinate(i, axis); }) {
      return points.coordinate(i, axis);
    } else {
      return points[i][static_cast<Eigen::Index>(axis)];
    }
  }
  /// None is known: the tree finds the bounding box itself.
  template <typename Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

}  // namespace traverse::geometry
