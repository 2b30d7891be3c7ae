#include "traverse/render/pictures/map_in_perspective.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/Eigenvalues>

#include "traverse/render/palette.hpp"

#include "pictures/map_points.hpp"
#include "pictures/note.hpp"
#include "plot/colour_bar.hpp"
#include "plot/legend.hpp"
#include "plot/number_text.hpp"
#include "plot/title_block.hpp"

namespace traverse::render {

namespace {

constexpr double kFieldOfView = 45 * std::numbers::pi / 180;  // vertical
constexpr double kElevation = 32 * std::numbers::pi / 180;    // of the eye above the ground
constexpr double kAround_m = 25;  // of the map that the picture holds at the ends of the way

/// The way as it lies: its middle, and the horizontal direction across it.
struct Lie {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  double half_length = 1;
};

Lie lie_of(const geometry::Trajectory& trajectory) {
  Lie lie;
  if (trajectory.empty()) return lie;
  Eigen::Vector3d low = trajectory.pose(0).translation;
  Eigen::Vector3d high = low;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& pose : trajectory.poses()) {
    low = low.cwiseMin(pose.translation);
    high = high.cwiseMax(pose.translation);
    mean += pose.translation.head<2>() / static_cast<double>(trajectory.size());
  }
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const auto& pose : trajectory.poses()) {
    const Eigen::Vector2d d = pose.translation.head<2>() - mean;
    spread += d * d.transpose();
  }
  lie.middle = (low + high) / 2;
  lie.along = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors().col(1);
  const Eigen::Vector2d end =
      trajectory.poses().back().translation.head<2>() - trajectory.pose(0).translation.head<2>();
  if (lie.along.dot(end) < 0) lie.along = -lie.along;  // the way goes to the right
  lie.half_length = (high - low).head<2>().norm() / 2 + kAround_m;
  return lie;
}

Camera camera_beside(const Lie& lie, double aspect) {
  // The way fills the width; seen from its right side, so that it goes to the right.
  const double distance = lie.half_length / (std::tan(kFieldOfView / 2) * aspect) * 1.05;
  const Eigen::Vector2d to_the_right(lie.along.y(), -lie.along.x());
  Eigen::Vector3d direction;
  direction << std::cos(kElevation) * to_the_right, std::sin(kElevation);
  const Eigen::Vector3d eye = distance * direction;  // the middle of the way is the origin
  return Camera::looking_at(eye, Eigen::Vector3d::Zero(), kFieldOfView, aspect, 0.05 * distance,
                            20 * distance);
}

void draw_way(Canvas& canvas, const geometry::Trajectory& trajectory, const Camera& camera,
              const Rect& viewport, const Eigen::Vector3d& centre) {
  Polyline line;
  for (const auto& pose : trajectory.poses()) {
    const Eigen::Vector3d p = pose.translation - centre;
    const bool ahead = camera.depth(p) > camera.near;
    line.points.push_back(ahead ? camera.project(p, viewport)
                                : Point{std::numeric_limits<double>::quiet_NaN(), 0});
  }
  line.width = 2.8 * canvas.sizes().line;
  line.colour = canvas.theme().background;
  canvas.add(line, viewport);
  line.width = 1.4 * canvas.sizes().line;
  line.colour = palette::kVermillion;
  canvas.add(std::move(line), viewport);
}

}  // namespace

Drawing map_in_perspective(const MapPoints& points, const PointValues& values,
                           const geometry::Trajectory& trajectory, const Caption& caption,
                           const Style& style) {
  check_sizes(points, values);
  Canvas canvas(style);
  const Sizes& sizes = canvas.sizes();
  const ColourBar bar{scale_of(points, values), values.name, values.unit};
  const Rect page = draw_title_block(canvas, caption, "Map in perspective");
  Rect outer = page;
  outer.right -= colour_bar_width(canvas, bar) + 2 * sizes.gap;
  const Rect below = draw_legend_above(
      canvas,
      {{count_text(points.x.size()) + " points", style.theme.muted, Sample::kPoint},
       {"trajectory", palette::kVermillion, Sample::kLine}},
      outer, "");
  const Rect viewport{outer.left, below.top + Sizes::line_height(sizes.body), outer.right,
                      outer.bottom};
  draw_colour_bar(canvas, bar,
                  {outer.right + 2 * sizes.gap, page.top, page.right, viewport.bottom});

  const Lie lie = lie_of(trajectory);
  PointCloud cloud;
  cloud.points = coloured_points(points, values, bar.scale, lie.middle);
  cloud.camera = camera_beside(lie, viewport.width() / viewport.height());
  cloud.viewport = viewport;
  cloud.diameter = 0.8 * sizes.line;
  cloud.depth_shading = kDepthShading;
  const Camera camera = cloud.camera;
  if (cloud.points.empty()) draw_note(canvas, viewport, "no points");
  canvas.add(std::move(cloud), viewport);
  draw_way(canvas, trajectory, camera, viewport, lie.middle);
  return std::move(canvas).finish();
}

}  // namespace traverse::render
