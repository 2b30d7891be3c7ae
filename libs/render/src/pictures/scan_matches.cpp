#include "traverse/render/pictures/scan_matches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "traverse/render/palette.hpp"
#include "traverse/render/plot/colour_bar.hpp"
#include "traverse/render/plot/legend.hpp"
#include "traverse/render/plot/number_text.hpp"
#include "traverse/render/plot/occupancy.hpp"
#include "traverse/render/plot/path.hpp"
#include "traverse/render/plot/scale_bar.hpp"
#include "traverse/render/plot/ticks.hpp"
#include "traverse/render/plot/title_block.hpp"

#include "pictures/map_points.hpp"
#include "pictures/note.hpp"

namespace traverse::render {

namespace {

constexpr double kShown_m = 50;        // to each side of the way: farther, a scan is thin
constexpr double kStrayPercent = 2;    // of the matches, at each end of each axis, may be cut off
constexpr double kLongResidual = 95;   // percent of the residuals are shorter
constexpr double kLongOnPaper = 0.03;  // of the picture's width, what such a one is drawn as

std::vector<float> sizes_of(const RegisteredScan& registered) {
  std::vector<float> sizes;
  for (std::size_t i = 0; i < registered.matches.x.size(); ++i) {
    const auto at = [i](std::span<const float> values) { return static_cast<double>(values[i]); };
    sizes.push_back(static_cast<float>(
        std::hypot(at(registered.offset_x), at(registered.offset_y), at(registered.offset_z))));
  }
  return sizes;
}

void check_offsets(const RegisteredScan& registered) {
  const std::size_t count = registered.matches.x.size();
  for (const auto& offsets : {registered.offset_x, registered.offset_y, registered.offset_z}) {
    if (offsets.size() != count) throw std::invalid_argument("a match needs one offset");
  }
}

/// What nearly all of the matches lie in, or of the scan where there are none, but no more than
/// kShown_m around the way.
Range shown(std::span<const float> values, double origin, const Range& way) {
  const Range most{way.low - kShown_m, way.high + kShown_m};
  const double low = origin + percentile(values, kStrayPercent);
  const double high = origin + percentile(values, 100 - kStrayPercent);
  if (!std::isfinite(low) || !std::isfinite(high)) return most;
  return way.joined({std::max(low, most.low), std::min(high, most.high)}).at_least(2).padded(0.04);
}

/// How many times as long as they are the residuals are drawn: a round number.
double times_as_long(const std::vector<float>& sizes, const PlotArea& area) {
  const double residual = percentile(sizes, kLongResidual);
  if (!(residual > 0)) return 1;
  return std::max(1.0, nice_step_at_most(kLongOnPaper * area.x.range.span() / residual));
}

PointCloud cloud_in(const PlotArea& area, std::vector<ScenePoint> points, double diameter) {
  double lowest = 0;
  double highest = 0;
  for (const ScenePoint& p : points) {
    lowest = std::min<double>(lowest, p.z);
    highest = std::max<double>(highest, p.z);
  }
  PointCloud cloud;
  cloud.diameter = diameter;
  cloud.points = std::move(points);
  cloud.camera =
      Camera::from_above({0, 0}, area.x.range.span() / 2, area.y.range.span() / 2, lowest, highest);
  cloud.viewport = area.rect;
  return cloud;
}

std::vector<ScenePoint> grey_points(const MapPoints& points, const Eigen::Vector3d& centre,
                                    Colour grey) {
  std::vector<ScenePoint> scene = coloured_points(points, {}, {}, centre);
  for (ScenePoint& p : scene) p.colour = grey;
  return scene;
}

/// A line from each match as far as its residual goes, `times` as long.
Polyline residual_lines(const RegisteredScan& registered, const std::vector<float>& sizes,
                        const PlotArea& area, double times, const ColourScale& scale) {
  Polyline lines;
  lines.cap = LineCap::kButt;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double x = registered.matches.origin.x() + registered.matches.x[i];
    const double y = registered.matches.origin.y() + registered.matches.y[i];
    lines.points.push_back(area.at(x, y));
    lines.points.push_back(
        area.at(x + times * registered.offset_x[i], y + times * registered.offset_y[i]));
    lines.points.push_back({std::numeric_limits<double>::quiet_NaN(), 0});
    lines.colours.insert(lines.colours.end(), 3, scale(sizes[i]));
  }
  return lines;
}

Occupancy occupancy_of(const MapPoints& points, const PlotArea& area, const Style& style) {
  Occupancy occupancy(style.width, style.height);
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    occupancy.add(area.at(points.origin.x() + points.x[i], points.origin.y() + points.y[i]));
  }
  return occupancy;
}

}  // namespace

Drawing scan_matches(const RegisteredScan& registered, const geometry::Trajectory& way,
                     const Caption& caption, const Style& style) {
  check_sizes(registered.scan, {});
  check_sizes(registered.matches, {});
  check_offsets(registered);
  Canvas canvas(style);
  const Sizes& sizes = canvas.sizes();
  const Path path = path_of(way);
  const std::vector<float> residuals = sizes_of(registered);
  const ColourBar bar{colour_scale(std::span<const float>(residuals), ColourMap::kViridis),
                      "residual", "m"};
  const bool any = !residuals.empty();
  const MapPoints& framed = any ? registered.matches : registered.scan;
  const Bounds bounds = bounds_of(path);

  const Rect page = draw_title_block(canvas, caption, "A scan and its matches");
  Rect outer = page;
  if (any) outer.right -= colour_bar_width(canvas, bar) + 2 * sizes.gap;
  // The legend tells the factor, which follows from the area below the legend: a first layout finds
  // it, and the number's width changes nothing.
  const auto lay_out_below = [&](const Rect& room) {
    return lay_out_equal(canvas, room, {"x", "m", shown(framed.x, framed.origin.x(), bounds.x)},
                         {"y", "m", shown(framed.y, framed.origin.y(), bounds.y)});
  };
  const double times = times_as_long(residuals, lay_out_below(outer));
  std::vector<LegendEntry> legend{{"scan", style.theme.other, Sample::kPoint}};
  if (any) {
    legend.push_back({count_text(residuals.size()) + " matches", bar.scale(bar.scale.shown.low),
                      Sample::kPoint});
    legend.push_back({"residual, " + fixed_text(times, 0) + " times as long",
                      bar.scale(bar.scale.shown.high), Sample::kLine});
  }
  legend.push_back({"way", palette::kVermillion, Sample::kLine});
  outer = draw_legend_above(canvas, legend, outer, "y [m]");
  const PlotArea area = lay_out_below(outer);
  draw_axes(canvas, area);
  if (any) {
    draw_colour_bar(canvas, bar,
                    {outer.right + 2 * sizes.gap, page.top, page.right, area.rect.bottom});
  }

  const Eigen::Vector3d centre{(area.x.range.low + area.x.range.high) / 2,
                               (area.y.range.low + area.y.range.high) / 2, framed.origin.z()};
  canvas.add(cloud_in(area, grey_points(registered.scan, centre, style.theme.other), sizes.line),
             area.rect);
  if (!any) draw_note(canvas, area.rect, "the estimator did not tell its matches");
  Polyline lines = residual_lines(registered, residuals, area, times, bar.scale);
  lines.width = 0.8 * sizes.line;
  canvas.add(std::move(lines), area.rect);
  const PointValues values{residuals, "residual", "m", ColourMap::kViridis};
  if (any) {
    canvas.add(cloud_in(area, coloured_points(registered.matches, values, bar.scale, centre),
                        1.8 * sizes.line),
               area.rect);
  }
  Polyline line;
  line.points = seen_from_above(path, area);
  const std::vector<Point> points = line.points;
  line.colour = palette::kVermillion;
  line.width = 1.4 * sizes.line;
  canvas.add(std::move(line), area.rect);
  draw_path_marks(canvas, points, path, palette::kVermillion);
  draw_scale_bar(canvas, area, occupancy_of(registered.scan, area, style));
  return std::move(canvas).finish();
}

}  // namespace traverse::render
