#include "traverse/render/pictures/map_from_above.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "traverse/render/palette.hpp"

#include "pictures/map_points.hpp"
#include "pictures/note.hpp"
#include "plot/colour_bar.hpp"
#include "plot/legend.hpp"
#include "plot/north_arrow.hpp"
#include "plot/number_text.hpp"
#include "plot/occupancy.hpp"
#include "plot/path.hpp"
#include "plot/scale_bar.hpp"
#include "plot/title_block.hpp"

namespace traverse::render {

namespace {

constexpr double kStrayPercent = 0.5;    // of the points, at each end of each axis, may be cut off
constexpr double kLeastDiameter = 1.25;  // pixels
constexpr double kLargestDiameter = 4;

Range percentiles(std::span<const float> values, double origin) {
  return {origin + percentile(values, kStrayPercent),
          origin + percentile(values, 100 - kStrayPercent)};
}

/// What the picture must hold, in the map frame.
Bounds shown_bounds(const MapPoints& points, const Path& path) {
  std::optional<Bounds> bounds;
  const Range x = percentiles(points.x, points.origin.x());
  const Range y = percentiles(points.y, points.origin.y());
  if (std::isfinite(x.span()) && std::isfinite(y.span())) bounds = Bounds{x, y, {}};
  if (!path.empty()) {
    const Bounds more = bounds_of(path);
    bounds = bounds ? Bounds{bounds->x.joined(more.x), bounds->y.joined(more.y), {}} : more;
  }
  Bounds shown = bounds.value_or(Bounds{});
  shown.x = shown.x.at_least(1).padded(0.02);
  shown.y = shown.y.at_least(1).padded(0.02);
  return shown;
}

/// Points as large as leaves no holes between them where they are dense, within limits.
double diameter_for(std::size_t points, const PlotArea& area, const Sizes& sizes) {
  const double pixels_a_point =
      area.rect.width() * area.rect.height() / std::max(1.0, static_cast<double>(points));
  const double print = std::max(1.0, sizes.line / 2);  // finer in large pictures
  return std::clamp(std::sqrt(pixels_a_point), print * kLeastDiameter, print * kLargestDiameter);
}

PointCloud cloud_in(const PlotArea& area, std::vector<ScenePoint> points, const Sizes& sizes) {
  float lowest = 0;
  float highest = 0;
  if (!points.empty()) {
    const auto [low, high] =
        std::minmax_element(points.begin(), points.end(),
                            [](const ScenePoint& a, const ScenePoint& b) { return a.z < b.z; });
    lowest = low->z;
    highest = high->z;
  }
  PointCloud cloud;
  cloud.diameter = diameter_for(points.size(), area, sizes);
  cloud.points = std::move(points);
  cloud.camera =
      Camera::from_above({0, 0}, area.x.range.span() / 2, area.y.range.span() / 2, lowest, highest);
  cloud.viewport = area.rect;
  cloud.depth_shading = kDepthShading;
  return cloud;
}

void draw_trajectory(Canvas& canvas, const PlotArea& area, const Path& path, Colour colour) {
  Polyline line;
  line.points = seen_from_above(path, area);
  const std::vector<Point> points = line.points;
  line.width = 2.8 * canvas.sizes().line;
  line.colour = canvas.theme().background;
  canvas.add(line, area.rect);
  line.width = 1.4 * canvas.sizes().line;
  line.colour = colour;
  canvas.add(std::move(line), area.rect);
  draw_path_marks(canvas, points, path, colour);
}

Occupancy occupancy_of(const PointCloud& cloud, const Style& style) {
  Occupancy occupancy(style.width, style.height);
  const Camera& camera = cloud.camera;
  for (const ScenePoint& p : cloud.points) {
    occupancy.add(
        {cloud.viewport.centre().x + p.x / camera.half_width * cloud.viewport.width() / 2,
         cloud.viewport.centre().y - p.y / camera.half_height * cloud.viewport.height() / 2});
  }
  return occupancy;
}
}  // namespace

Drawing map_from_above(const MapPoints& points, const PointValues& values,
                       const geometry::Trajectory* trajectory, const Caption& caption,
                       const Style& style, const std::optional<Eigen::Vector3d>& north) {
  check_sizes(points, values);
  Canvas canvas(style);
  const Sizes& sizes = canvas.sizes();
  const Path path = trajectory != nullptr ? path_of(*trajectory) : Path{};
  const ColourBar bar{scale_of(points, values), values.name, values.unit};
  // Not the estimate's blue, which would drown in the blues and greens of the map.
  const Colour line_colour = palette::kVermillion;

  const Rect page = draw_title_block(canvas, caption, "Map from above");
  Rect outer = page;
  outer.right -= colour_bar_width(canvas, bar) + 2 * sizes.gap;
  std::vector<LegendEntry> legend{
      {count_text(points.x.size()) + " points", style.theme.muted, Sample::kPoint}};
  if (!path.empty()) {
    legend.push_back({"trajectory", line_colour, Sample::kLine});
    legend.push_back({"start", line_colour, Sample::kStart});
    legend.push_back({"end", line_colour, Sample::kEnd});
  }
  outer = draw_legend_above(canvas, legend, outer, "y [m]");
  const Bounds shown = shown_bounds(points, path);
  const PlotArea area = lay_out_equal(canvas, outer, {"x", "m", shown.x}, {"y", "m", shown.y});
  draw_axes(canvas, area);
  draw_colour_bar(canvas, bar,
                  {outer.right + 2 * sizes.gap, page.top, page.right, area.rect.bottom});

  const Eigen::Vector3d centre{(area.x.range.low + area.x.range.high) / 2,
                               (area.y.range.low + area.y.range.high) / 2, points.origin.z()};
  PointCloud cloud = cloud_in(area, coloured_points(points, values, bar.scale, centre), sizes);
  const Occupancy occupancy = occupancy_of(cloud, style);
  if (cloud.points.empty()) draw_note(canvas, area.rect, "no points");
  canvas.add(std::move(cloud), area.rect);
  draw_trajectory(canvas, area, path, line_colour);
  draw_scale_bar(canvas, area, occupancy);
  if (north) draw_north_arrow(canvas, area, *north, occupancy);
  return std::move(canvas).finish();
}

}  // namespace traverse::render
