#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"
#include "traverse/simulation/material.hpp"

namespace traverse::simulation {

/// Sides of a post or trunk, which is round: the mean of the returns from a prism of 8 sides lies
/// 5 % less far before its axis (in half widths) than from a round one, of 24 sides 0.6 %.
inline constexpr int kRound = 24;

/// Surfaces as triangles, each seen from both sides. Metres.
class Mesh {
 public:
  using Corner = Eigen::Vector3d;

  void add_triangle(const Corner& a, const Corner& b, const Corner& c, Material material);
  /// A flat piece with its four corners in turn.
  void add_quad(const Corner& a, const Corner& b, const Corner& c, const Corner& d,
                Material material);
  /// All six sides; `T` places the box with its base's middle at the origin, size along x, y, z.
  void add_box(const geometry::Pose3& T, const Eigen::Vector3d& size, Material material);
  /// The mantle of a prism with `sides` sides, whose corners lie on circles about the axis.
  void add_tube(const Corner& from, const Corner& to, double radius_from, double radius_to,
                int sides, Material material);
  /// A flat disc as a polygon with `sides` sides.
  void add_disc(const Corner& centre, const Eigen::Vector3d& axis, double radius, int sides,
                Material material);
  /// A copy of `mesh`, moved.
  void add(const Mesh& mesh, const geometry::Pose3& T, double scale = 1);

  std::size_t size() const { return triangles_.size(); }
  const std::vector<Corner>& corners() const { return corners_; }
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }
  Material material(std::size_t triangle) const { return materials_[triangle]; }

 private:
  std::uint32_t add_corner(const Corner& corner);
  void add_indices(std::uint32_t a, std::uint32_t b, std::uint32_t c, Material material);

  std::vector<Corner> corners_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Material> materials_;
};

/// A pose upright at `point`, turned by `yaw` [rad].
geometry::Pose3 upright(const Eigen::Vector3d& point, double yaw);

}  // namespace traverse::simulation
