#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <stdexcept>

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"

namespace traverse::geometry {

/// y ~ scale * R x + t.
struct Similarity {
  Pose3 T_y_x;
  double scale = 1;
};

/// The points do not determine the transform (fewer than three that are not on one line).
class DegenerateAlignment : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The similarity (or, without scale, the rigid transform) that brings the points x onto their
/// partners y with the least sum of squares. Source: Umeyama, "Least-squares estimation of
/// transformation parameters between two point patterns", PAMI 1991, eqs. 40-43; degenerate if
/// fewer than two singular values of the covariance exceed the double epsilon, as in evo.
/// \throws std::invalid_argument if the sizes differ, are zero, or a point is not finite;
/// DegenerateAlignment.
Similarity umeyama(std::span<const Eigen::Vector3d> x, std::span<const Eigen::Vector3d> y,
                   bool with_scale);

/// The same of `count` points each that x and y tell one by one; each is asked twice.
Similarity umeyama(std::size_t count, const std::function<Eigen::Vector3d(std::size_t)>& x,
                   const std::function<Eigen::Vector3d(std::size_t)>& y, bool with_scale);

}  // namespace traverse::geometry
