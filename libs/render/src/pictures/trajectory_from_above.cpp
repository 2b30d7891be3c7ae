#include "traverse/render/pictures/trajectory_from_above.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "traverse/render/palette.hpp"

#include "pictures/trajectory_lines.hpp"
#include "plot/legend.hpp"
#include "plot/north_arrow.hpp"
#include "plot/number_text.hpp"
#include "plot/occupancy.hpp"
#include "plot/path.hpp"
#include "plot/scale_bar.hpp"
#include "plot/title_block.hpp"

namespace traverse::render {

namespace {

std::vector<LegendEntry> legend_of(std::span<const NamedTrajectory> estimates,
                                   const std::vector<Path>& paths, bool with_reference,
                                   const ShownFixes& fixes, const Theme& theme) {
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    entries.push_back({estimates[i].name, palette::series(i), Sample::kLine});
  }
  if (with_reference) entries.push_back({"reference", theme.reference, Sample::kDashedLine});
  if (!fixes.taken.empty()) entries.push_back({"fixes", theme.muted, Sample::kPoint});
  if (!fixes.rejected.empty()) {
    entries.push_back({"fixes, rejected", palette::kOrange, Sample::kPoint});
  }
  if (paths.empty() || paths.front().empty()) return entries;
  entries.push_back({"start", palette::series(0), Sample::kStart});
  entries.push_back({"end", palette::series(0), Sample::kEnd});
  if (paths.front().length() > 0) {
    entries.push_back({"every 10 % of the path, " + value_text(paths.front().length() / 10) + " m",
                       theme.text, Sample::kTick});
  }
  return entries;
}

/// What is drawn in an area: the map as a whole, or a detail of it.
struct Shown {
  std::vector<Path> paths;
  Path reference;
  const ShownFixes& fixes;
};

/// Points that would lie on one another are left out: a receiver tells thousands.
std::vector<Point> spread(const std::vector<Eigen::Vector3d>& places, const PlotArea& area,
                          double apart) {
  std::vector<Point> points;
  for (const Eigen::Vector3d& place : places) {
    const Point at = area.at(place.x(), place.y());
    if (!is_finite(at) || !area.rect.contains(at)) continue;
    const bool is_apart =
        points.empty() || std::hypot(at.x - points.back().x, at.y - points.back().y) >= apart;
    if (is_apart) points.push_back(at);
  }
  return points;
}

void draw_fixes(Canvas& canvas, const PlotArea& area, const ShownFixes& fixes) {
  const double line = canvas.sizes().line;
  for (const Point at : spread(fixes.taken, area, line)) {
    canvas.add(Disc{at, 1.1 * line, canvas.theme().muted, 0.7}, area.rect);
  }
  for (const Point at : spread(fixes.rejected, area, line)) {
    const double arm = 2.2 * line;
    for (const double side : {-1.0, 1.0}) {
      Polyline stroke;
      stroke.points = {at + Point{-arm, -side * arm}, at + Point{arm, side * arm}};
      stroke.colour = palette::kOrange;
      stroke.width = 0.8 * line;
      canvas.add(std::move(stroke), area.rect);
    }
  }
}

void draw_lines(Canvas& canvas, const PlotArea& area, const Shown& shown) {
  draw_fixes(canvas, area, shown.fixes);
  for (std::size_t i = 0; i < shown.paths.size(); ++i) {
    draw_estimate(canvas, area, seen_from_above(shown.paths[i], area), palette::series(i));
  }
  draw_reference(canvas, area, seen_from_above(shown.reference, area));
}

void draw_frame(Canvas& canvas, const Rect& rect, Colour colour) {
  Polyline frame;
  frame.points = {{rect.left, rect.top},
                  {rect.right, rect.top},
                  {rect.right, rect.bottom},
                  {rect.left, rect.bottom}};
  frame.closed = true;
  frame.colour = colour;
  frame.width = canvas.sizes().hairline;
  canvas.add(std::move(frame));
}

/// The corner of the area that carries the least.
Rect emptiest_corner(const PlotArea& area, double side, double gap, const Occupancy& occupancy) {
  const Rect inside = area.rect.inset(gap);
  const auto room_at = [side](double left, double top) {
    return Rect{left, top, left + side, top + side};
  };
  const std::array<Rect, 4> corners{room_at(inside.right - side, inside.top),
                                    room_at(inside.left, inside.top),
                                    room_at(inside.right - side, inside.bottom - side),
                                    room_at(inside.left, inside.bottom - side)};
  return *std::min_element(corners.begin(), corners.end(), [&](const Rect& a, const Rect& b) {
    return occupancy.share(a) < occupancy.share(b);
  });
}

/// Also marks in `occupancy` where it stands.
void draw_detail(Canvas& canvas, const PlotArea& area, const MapDetail& detail, const Shown& shown,
                 Occupancy& occupancy) {
  constexpr double kShareOfArea = 0.4;
  constexpr double kShownBelow = 0.5;  // of the picture: what fills it needs no detail
  if (detail.width_m > kShownBelow * std::min(area.x.range.span(), area.y.range.span())) return;
  const Sizes& sizes = canvas.sizes();
  const double side = kShareOfArea * std::min(area.rect.width(), area.rect.height());
  const Rect rect = emptiest_corner(area, side, sizes.gap, occupancy);
  const double half = detail.width_m / 2;
  const Eigen::Vector3d& centre = detail.centre_map;
  PlotArea zoomed = area;
  zoomed.rect = rect;
  zoomed.x.range = {centre.x() - half, centre.x() + half};
  zoomed.y.range = {centre.y() - half, centre.y() + half};

  const Point low = area.at(zoomed.x.range.low, zoomed.y.range.low);
  const Point high = area.at(zoomed.x.range.high, zoomed.y.range.high);
  draw_frame(canvas, {low.x, high.y, high.x, low.y}, canvas.theme().text);
  canvas.fill(rect, canvas.theme().background);
  draw_lines(canvas, zoomed, shown);
  draw_frame(canvas, rect, canvas.theme().text);
  const Text text = canvas.note("detail, " + length_text(detail.width_m) + " wide",
                                {rect.left + sizes.gap, rect.bottom - sizes.gap});
  canvas.text(canvas.on_data(coloured(text, canvas.theme().text)));
  canvas.reserve(rect);
  for (double y = rect.top; y < rect.bottom; y += sizes.gap / 2) {
    const std::array<Point, 2> row{Point{rect.left, y}, Point{rect.right, y}};
    occupancy.add_line(row);
  }
}

}  // namespace

Drawing trajectory_from_above(std::span<const NamedTrajectory> estimates,
                              const geometry::Trajectory* reference, const Caption& caption,
                              const Style& style, const BesideTrajectories& beside) {
  Canvas canvas(style);
  Shown shown{{}, reference != nullptr ? path_of(*reference) : Path{}, beside.fixes};
  std::vector<Path>& paths = shown.paths;
  for (const NamedTrajectory& estimate : estimates) paths.push_back(path_of(*estimate.trajectory));
  const Path& reference_path = shown.reference;

  const Rect page = draw_title_block(canvas, caption, "Trajectory from above");
  const Rect outer = draw_legend_above(
      canvas, legend_of(estimates, paths, !reference_path.empty(), beside.fixes, style.theme), page,
      "y [m]");
  std::vector<const Path*> all{&reference_path};
  for (const Path& path : paths) all.push_back(&path);
  const PlotArea area = lay_out_from_above(canvas, outer, all);
  draw_axes(canvas, area);

  Occupancy occupancy(style.width, style.height);
  for (const Path& path : paths) occupancy.add_line(seen_from_above(path, area));
  draw_lines(canvas, area, shown);
  if (beside.detail) draw_detail(canvas, area, *beside.detail, shown, occupancy);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    draw_path_marks(canvas, seen_from_above(paths[i], area), paths[i], palette::series(i));
  }
  draw_scale_bar(canvas, area, occupancy);
  if (beside.north_map) draw_north_arrow(canvas, area, *beside.north_map, occupancy);
  return std::move(canvas).finish();
}

}  // namespace traverse::render
