#include "path_ribbon.hpp"

#include "look.hpp"

namespace traverse::app {

namespace {

constexpr std::size_t kMostPieces = 2000;  // far from the present
constexpr std::size_t kNear = 200;         // vertices on each side of it
constexpr float kLeastPiece = 1e-4F;       // metres

void append_piece(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const RibbonStyle& style,
                  mrpt::opengl::CSetOfTriangles& ribbon) {
  const Eigen::Vector3f along = b - a;
  if (along.head<2>().norm() < kLeastPiece) return;
  const Eigen::Vector3f side =
      Eigen::Vector3f(-along.y(), along.x(), 0).normalized() * (style.width_m / 2);
  const auto triangle = [&](const Eigen::Vector3f& p, const Eigen::Vector3f& q,
                            const Eigen::Vector3f& r) {
    mrpt::opengl::TTriangle t(to_mrpt(p), to_mrpt(q), to_mrpt(r));
    t.setColor(to_mrpt(style.colour));
    t.computeNormals();
    ribbon.insertTriangle(t);
  };
  triangle(a - side, b - side, b + side);
  triangle(a - side, b + side, a + side);
}

}  // namespace

void draw_path(std::span<const Eigen::Vector3f> path, std::size_t near, const RibbonStyle& style,
               mrpt::opengl::CSetOfTriangles& ribbon) {
  ribbon.clearTriangles();
  const std::size_t stride = 1 + path.size() / kMostPieces;
  bool drawn = true;
  for (std::size_t i = 0; i + 1 < path.size();) {
    const bool is_near = i + kNear >= near && i < near + kNear;
    const std::size_t next = std::min(i + (is_near ? 1 : stride), path.size() - 1);
    if (drawn) append_piece(path[i], path[next], style, ribbon);
    drawn = !style.dashed || !drawn;
    i = next;
  }
}

}  // namespace traverse::app
