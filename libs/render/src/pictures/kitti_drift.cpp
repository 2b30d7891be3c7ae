#include "traverse/render/pictures/kitti_drift.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "traverse/render/palette.hpp"

#include "pictures/note.hpp"
#include "plot/level_line.hpp"
#include "plot/number_text.hpp"
#include "plot/stacked_panels.hpp"
#include "plot/title_block.hpp"

namespace traverse::render {

namespace {

constexpr double kHeadRoom = 1.25;  // for the counts above the points

/// One of the two numbers, over length.
struct Drift {
  std::string name;
  std::string unit;
  double DriftAtLength::*value;
};

double mean_over_segments(std::span<const DriftAtLength> drift, double DriftAtLength::*value) {
  double sum = 0;
  double count = 0;
  for (const DriftAtLength& at : drift) {
    if (!std::isfinite(at.*value)) continue;
    sum += static_cast<double>(at.segments) * at.*value;
    count += static_cast<double>(at.segments);
  }
  return sum / count;
}

Range values_range(std::span<const DriftAtLength> drift, double DriftAtLength::*value) {
  std::vector<double> values;
  for (const DriftAtLength& at : drift) values.push_back(at.*value);
  const double high = Range::of(values).high;
  return {0, kHeadRoom * (high > 0 ? high : 1)};
}

Range lengths_range(std::span<const DriftAtLength> drift) {
  std::vector<double> lengths;
  for (const DriftAtLength& at : drift) lengths.push_back(at.length_m);
  const Range range = Range::of(lengths);
  const double room = std::max(50.0, 0.06 * range.span());
  return {range.low - room, range.high + room};
}

void draw_mean(Canvas& canvas, const PlotArea& area, double mean, const std::string& unit) {
  if (!std::isfinite(mean)) return;
  draw_level_line(canvas, area, mean);
  const Sizes& sizes = canvas.sizes();
  const Text label = canvas.note("mean of all segments " + value_text(mean) + " " + unit, {},
                                 HorizontalAlign::kRight);
  const double right = area.rect.right - sizes.gap / 2;
  const double y = area.y_at(mean);
  canvas.text_at_first_free(canvas.on_data(coloured(label, canvas.theme().text)),
                            {{right, y + 1.2 * sizes.tick}, {right, y - 0.45 * sizes.tick}});
}

void draw_drift(Canvas& canvas, const PlotArea& area, std::span<const DriftAtLength> drift,
                double DriftAtLength::*value, bool with_counts) {
  const Colour colour = palette::kBlue;
  const double mean_y = area.y_at(mean_over_segments(drift, value));
  const Sizes& sizes = canvas.sizes();
  Polyline line;
  line.colour = colour;
  line.width = sizes.line;
  for (const DriftAtLength& at : drift) {
    line.points.push_back(area.at(at.length_m, at.*value));
  }
  const std::vector<Point> points = line.points;
  canvas.add(std::move(line), area.rect);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i].y)) continue;
    canvas.add(Disc{points[i], 2.8 * sizes.line, canvas.theme().background, 1});
    canvas.add(Disc{points[i], 2.2 * sizes.line, colour, 1});
    if (!with_counts) continue;
    // Above the point, or below where the line of the mean would run through it.
    const double above = points[i].y - 4 * sizes.line;
    const bool crossed = mean_y < above + 0.3 * sizes.tick && mean_y > above - sizes.tick;
    const double baseline = crossed ? points[i].y + 4 * sizes.line + 0.8 * sizes.tick : above;
    canvas.text(canvas.on_data(canvas.note("n = " + count_text(drift[i].segments),
                                           {points[i].x, baseline}, HorizontalAlign::kCentre)));
  }
}

}  // namespace

Drawing kitti_drift(std::span<const DriftAtLength> drift, const Caption& caption,
                    const Style& style) {
  Canvas canvas(style);
  const Rect page = draw_title_block(canvas, caption, "Drift by segment length");
  if (drift.empty()) {
    draw_note(canvas, page, "not defined: the path has no segment of 100 m");
    return std::move(canvas).finish();
  }
  const std::vector<Drift> both{{"translation", "%", &DriftAtLength::translation_percent},
                                {"rotation", "°/100 m", &DriftAtLength::rotation_deg_per_100m}};
  const Axis x{"segment length", "m", lengths_range(drift)};
  std::vector<Axis> y;
  y.reserve(both.size());
  for (const Drift& part : both) {
    y.push_back({part.name, part.unit, values_range(drift, part.value)});
  }
  const std::vector<StackedPanel> panels = stacked_panels(canvas, page, y);
  for (std::size_t i = 0; i < both.size(); ++i) {
    const PlotArea area = lay_out(canvas, panels[i].outer, x, y[i], panels[i].margins);
    draw_axes(canvas, area, panels[i].margins);
    draw_drift(canvas, area, drift, both[i].value, i == 0);
    draw_mean(canvas, area, mean_over_segments(drift, both[i].value), both[i].unit);
  }
  return std::move(canvas).finish();
}

}  // namespace traverse::render
