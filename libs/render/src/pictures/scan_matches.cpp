#include "traverse/render/pictures/scan_matches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "traverse/render/palette.hpp"

#include "pictures/map_points.hpp"
#include "pictures/note.hpp"
#include "plot/legend.hpp"
#include "plot/number_text.hpp"
#include "plot/occupancy.hpp"
#include "plot/path.hpp"
#include "plot/scale_bar.hpp"
#include "plot/ticks.hpp"
#include "plot/title_block.hpp"

namespace traverse::render {

namespace {

constexpr double kShown_m = 50;  // to each side of the way: farther, a scan is thin
constexpr double kMatchStrayPercent =
    2;                                 // of the matches, at each end of each axis, may be cut off
constexpr double kLongResidual = 95;   // percent of the residuals are shorter
constexpr double kLongOnPaper = 0.03;  // of the picture's width, what such a one is drawn as

const Colour kOnLine = palette::kSharp;
const Colour kOnPlane = palette::kFlat;
const Colour kWay = palette::kGreen;

void check(const Matches& matches) {
  check_sizes(matches.points, {});
  for (const auto& offsets : {matches.offset_x, matches.offset_y, matches.offset_z}) {
    if (offsets.size() != matches.size()) {
      throw std::invalid_argument("a match needs one offset");
    }
  }
}

void append_sizes(const Matches& matches, std::vector<float>& sizes) {
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const auto at = [i](std::span<const float> values) { return static_cast<double>(values[i]); };
    sizes.push_back(static_cast<float>(
        std::hypot(at(matches.offset_x), at(matches.offset_y), at(matches.offset_z))));
  }
}

/// One coordinate of all matches, or of the scan where there are none, in the map frame.
std::vector<float> framed(const RegisteredScan& registered,
                          std::span<const float> MapPoints::*coordinate, int axis) {
  std::vector<float> values;
  const auto append = [&](const MapPoints& points) {
    for (const float value : points.*coordinate) {
      values.push_back(static_cast<float>(points.origin[axis] + value));
    }
  };
  append(registered.on_lines.points);
  append(registered.on_planes.points);
  if (values.empty()) append(registered.scan);
  return values;
}

/// What nearly all of the matches lie in, or of the scan where there are none, but no more than
/// kShown_m around the way.
Range shown(std::span<const float> values, const Range& way) {
  const Range most{way.low - kShown_m, way.high + kShown_m};
  const double low = percentile(values, kMatchStrayPercent);
  const double high = percentile(values, 100 - kMatchStrayPercent);
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

std::vector<ScenePoint> points_in(const MapPoints& points, const Eigen::Vector3d& centre,
                                  Colour colour) {
  std::vector<ScenePoint> scene = coloured_points(points, {}, {}, centre);
  for (ScenePoint& p : scene) p.colour = colour;
  return scene;
}

/// A line from each match as far as its residual goes, `times` as long.
Polyline residual_lines(const Matches& matches, const PlotArea& area, double times, Colour colour) {
  Polyline lines;
  lines.cap = LineCap::kButt;
  lines.colour = colour;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const double x = matches.points.origin.x() + matches.points.x[i];
    const double y = matches.points.origin.y() + matches.points.y[i];
    lines.points.push_back(area.at(x, y));
    lines.points.push_back(
        area.at(x + times * matches.offset_x[i], y + times * matches.offset_y[i]));
    lines.points.push_back({std::numeric_limits<double>::quiet_NaN(), 0});
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
  check(registered.on_lines);
  check(registered.on_planes);
  Canvas canvas(style);
  const Sizes& sizes = canvas.sizes();
  const Path path = path_of(way);
  std::vector<float> residuals;
  append_sizes(registered.on_lines, residuals);
  append_sizes(registered.on_planes, residuals);
  const Bounds bounds = bounds_of(path);
  const Range x_range = shown(framed(registered, &MapPoints::x, 0), bounds.x);
  const Range y_range = shown(framed(registered, &MapPoints::y, 1), bounds.y);

  Rect outer = draw_title_block(canvas, caption, "A scan and its matches");
  // The legend tells the factor, which follows from the area below the legend: a first layout finds
  // it, and the number's width changes nothing.
  const auto lay_out_below = [&](const Rect& room) {
    return lay_out_equal(canvas, room, {"x", "m", x_range}, {"y", "m", y_range});
  };
  const double times = times_as_long(residuals, lay_out_below(outer));
  std::vector<LegendEntry> legend{{"scan", style.theme.other, Sample::kPoint}};
  if (!residuals.empty()) {
    legend.push_back(
        {count_text(registered.on_planes.size()) + " on planes", kOnPlane, Sample::kPoint});
    legend.push_back(
        {count_text(registered.on_lines.size()) + " on lines", kOnLine, Sample::kPoint});
    legend.push_back(
        {"residual, " + fixed_text(times, 0) + " times as long", style.theme.other, Sample::kLine});
  }
  legend.push_back({"way", kWay, Sample::kLine});
  outer = draw_legend_above(canvas, legend, outer, "y [m]");
  const PlotArea area = lay_out_below(outer);
  draw_axes(canvas, area);

  const Eigen::Vector3d centre{(area.x.range.low + area.x.range.high) / 2,
                               (area.y.range.low + area.y.range.high) / 2,
                               registered.scan.origin.z()};
  canvas.add(cloud_in(area, points_in(registered.scan, centre, style.theme.other), sizes.line),
             area.rect);
  if (residuals.empty()) draw_note(canvas, area.rect, "the estimator did not keep its matches");
  // Lines are few: they come last, above the planes.
  for (const auto& [matches, colour] :
       {std::pair(&registered.on_planes, kOnPlane), std::pair(&registered.on_lines, kOnLine)}) {
    if (matches->size() == 0) continue;
    Polyline lines = residual_lines(*matches, area, times, colour);
    lines.width = 0.8 * sizes.line;
    canvas.add(std::move(lines), area.rect);
    canvas.add(cloud_in(area, points_in(matches->points, centre, colour), 1.8 * sizes.line),
               area.rect);
  }
  Polyline line;
  line.points = seen_from_above(path, area);
  const std::vector<Point> points = line.points;
  line.colour = kWay;
  line.width = 1.4 * sizes.line;
  canvas.add(std::move(line), area.rect);
  draw_path_marks(canvas, points, path, kWay);
  draw_scale_bar(canvas, area, occupancy_of(registered.scan, area, style));
  return std::move(canvas).finish();
}

}  // namespace traverse::render
