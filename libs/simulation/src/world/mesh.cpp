#include "traverse/simulation/mesh.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace traverse::simulation {

using geometry::Pose3;

std::uint32_t Mesh::add_corner(const Corner& corner) {
  corners_.push_back(corner);
  return static_cast<std::uint32_t>(corners_.size() - 1);
}

void Mesh::add_indices(std::uint32_t a, std::uint32_t b, std::uint32_t c, Material material) {
  triangles_.push_back({a, b, c});
  materials_.push_back(material);
}

void Mesh::add_triangle(const Corner& a, const Corner& b, const Corner& c, Material material) {
  const std::uint32_t first = add_corner(a);
  add_corner(b);
  add_corner(c);
  add_indices(first, first + 1, first + 2, material);
}

void Mesh::add_quad(const Corner& a, const Corner& b, const Corner& c, const Corner& d,
                    Material material) {
  const std::uint32_t first = add_corner(a);
  for (const Corner& corner : {b, c, d}) add_corner(corner);
  add_indices(first, first + 1, first + 2, material);
  add_indices(first, first + 2, first + 3, material);
}

void Mesh::add_box(const Pose3& T, const Eigen::Vector3d& size, Material material) {
  const auto corner = [&](int x, int y, int z) -> Corner {
    return T * Corner((x - 0.5) * size.x(), (y - 0.5) * size.y(), z * size.z());
  };
  for (const int side : {0, 1}) {
    add_quad(corner(side, 0, 0), corner(side, 1, 0), corner(side, 1, 1), corner(side, 0, 1),
             material);
    add_quad(corner(0, side, 0), corner(1, side, 0), corner(1, side, 1), corner(0, side, 1),
             material);
    add_quad(corner(0, 0, side), corner(1, 0, side), corner(1, 1, side), corner(0, 1, side),
             material);
  }
}

void Mesh::add_tube(const Corner& from, const Corner& to, double radius_from, double radius_to,
                    int sides, Material material) {
  const Eigen::Vector3d axis = (to - from).normalized();
  const Eigen::Vector3d u = axis.unitOrthogonal();
  const Eigen::Vector3d v = axis.cross(u);
  const auto on_circle = [&](const Corner& centre, double radius, int side) -> Corner {
    const double angle = 2 * std::numbers::pi * side / sides;
    return centre + radius * (std::cos(angle) * u + std::sin(angle) * v);
  };
  for (int side = 0; side < sides; ++side) {
    add_quad(on_circle(from, radius_from, side), on_circle(from, radius_from, side + 1),
             on_circle(to, radius_to, side + 1), on_circle(to, radius_to, side), material);
  }
}

void Mesh::add_disc(const Corner& centre, const Eigen::Vector3d& axis, double radius, int sides,
                    Material material) {
  const Eigen::Vector3d u = axis.unitOrthogonal();
  const Eigen::Vector3d v = axis.normalized().cross(u);
  const auto on_circle = [&](int side) -> Corner {
    const double angle = 2 * std::numbers::pi * side / sides;
    return centre + radius * (std::cos(angle) * u + std::sin(angle) * v);
  };
  for (int side = 0; side < sides; ++side) {
    add_triangle(centre, on_circle(side), on_circle(side + 1), material);
  }
}

void Mesh::add(const Mesh& mesh, const Pose3& T, double scale) {
  const auto offset = static_cast<std::uint32_t>(corners_.size());
  for (const Corner& corner : mesh.corners_) corners_.push_back(T * Corner(scale * corner));
  for (const auto& t : mesh.triangles_) {
    triangles_.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  materials_.insert(materials_.end(), mesh.materials_.begin(), mesh.materials_.end());
}

Pose3 upright(const Eigen::Vector3d& point, double yaw) {
  return Pose3::from_quaternion(
      Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())), point);
}

}  // namespace traverse::simulation
