#include "traverse/render/pictures/time_series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "traverse/render/palette.hpp"

#include "pictures/note.hpp"
#include "plot/decimation.hpp"
#include "plot/legend.hpp"
#include "plot/level_line.hpp"
#include "plot/stacked_panels.hpp"
#include "plot/title_block.hpp"

namespace traverse::render {

namespace {

constexpr double kSeriesGapOfMedian = 5;
constexpr double kSeriesHeadRoom = 0.06;

void check(const TimeSeries& data) {
  for (const Panel& panel : data.panels) {
    for (const Series& series : panel.series) {
      if (series.x.size() != series.y.size()) {
        throw std::invalid_argument("a series needs one y for each x");
      }
    }
  }
}

Range x_range(const TimeSeries& data) {
  std::vector<double> ends;
  for (const Panel& panel : data.panels) {
    for (const Series& series : panel.series) {
      const Range range = Range::of(series.x);
      if (!series.x.empty()) ends.insert(ends.end(), {range.low, range.high});
    }
  }
  return Range::of(ends);
}

/// Of all lines and the level; from zero where nothing is negative.
Range y_range(const Panel& panel) {
  std::vector<double> values;
  for (const Series& series : panel.series) {
    values.insert(values.end(), series.y.begin(), series.y.end());
  }
  if (panel.level) values.push_back(panel.level->value);
  const Range range = Range::of(values);
  if (range.low < 0) return range.padded(kSeriesHeadRoom);
  return {0, range.high > 0 ? range.high * (1 + kSeriesHeadRoom) : 1};
}

Colour shade_hue(std::size_t kind) { return kind == 0 ? palette::kOrange : palette::kPurple; }

Colour shade_colour(const Theme& theme, std::size_t kind) {
  return mix(theme.background, shade_hue(kind), theme.dark ? 0.35 : 0.3);
}

/// A single frame among thousands is less than a pixel wide: it is widened and drawn stronger.
void draw_spans(Canvas& canvas, const PlotArea& area, const std::vector<ShadedSpans>& kinds) {
  const double thin = 1.5 * canvas.sizes().line;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    for (const Range& span : kinds[kind].spans) {
      if (!std::isfinite(span.low) || !std::isfinite(span.high)) continue;
      const double left = area.x_at(span.low);
      const double width = area.x_at(span.high) - left;
      canvas.fill({std::max(left, area.rect.left), area.rect.top,
                   std::min(left + std::max(width, thin), area.rect.right), area.rect.bottom},
                  width < thin ? mix(canvas.theme().background, shade_hue(kind), 0.8)
                               : shade_colour(canvas.theme(), kind));
    }
  }
}

/// The points of a series in the picture, with a point that is not finite in each gap.
std::vector<Point> points_of(const Series& series, const PlotArea& area) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < series.x.size(); ++i) steps.push_back(series.x[i] - series.x[i - 1]);
  const double longest = kSeriesGapOfMedian * percentile(steps, 50);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<Point> points;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (i > 0 && steps[i - 1] > longest) points.push_back({kNone, kNone});
    points.push_back(area.at(series.x[i], series.y[i]));
  }
  return points;
}

void draw_series(Canvas& canvas, const PlotArea& area, const Series& series, Colour colour) {
  Polyline line;
  line.points = decimated(points_of(series, area));
  line.colour = colour;
  line.width = canvas.sizes().line;
  canvas.add(std::move(line), area.rect.inset(-canvas.sizes().line));
}

std::vector<LegendEntry> legend_of(const TimeSeries& data, std::size_t panel, const Theme& theme) {
  std::vector<LegendEntry> entries;
  const auto& series = data.panels[panel].series;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (!series[i].name.empty()) {
      entries.push_back({series[i].name, palette::series(i), Sample::kLine});
    }
  }
  if (const auto& level = data.panels[panel].level) {
    entries.push_back({level->label, theme.text, Sample::kDashedLine});
  }
  for (std::size_t kind = 0; panel == 0 && kind < data.shaded.size(); ++kind) {
    if (data.shaded[kind].spans.empty()) continue;
    entries.push_back({data.shaded[kind].name, shade_colour(theme, kind), Sample::kSwatch});
  }
  return entries;
}

bool has_values(const Panel& panel) {
  return std::any_of(panel.series.begin(), panel.series.end(), [](const Series& series) {
    return std::any_of(series.y.begin(), series.y.end(), [](double y) { return std::isfinite(y); });
  });
}

void draw_panel(Canvas& canvas, const Axis& x, const Axis& y, const TimeSeries& data,
                std::size_t index, const StackedPanel& place) {
  const Panel& panel = data.panels[index];
  const Rect outer = draw_legend_above(canvas, legend_of(data, index, canvas.theme()), place.outer,
                                       Notation::for_range(y.range).axis_label(y.name, y.unit));
  const PlotArea area = lay_out(canvas, outer, x, y, place.margins);
  draw_spans(canvas, area, data.shaded);
  draw_axes(canvas, area, place.margins);
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    draw_series(canvas, area, panel.series[i], palette::series(i));
  }
  if (panel.level) draw_level_line(canvas, area, panel.level->value);
  if (!has_values(panel)) draw_note(canvas, area.rect, "no values");
}

}  // namespace

Drawing time_series(const TimeSeries& data, const Caption& caption, const Style& style) {
  check(data);
  Canvas canvas(style);
  const Rect page = draw_title_block(canvas, caption, "Over " + data.x_name);
  if (data.panels.empty()) draw_note(canvas, page, "no series");
  const Axis x{data.x_name, data.x_unit, x_range(data)};
  std::vector<Axis> y;
  for (const Panel& panel : data.panels) y.push_back({panel.name, panel.unit, y_range(panel)});
  const std::vector<StackedPanel> places = stacked_panels(canvas, page, y);
  for (std::size_t i = 0; i < places.size(); ++i) {
    draw_panel(canvas, x, y[i], data, i, places[i]);
  }
  return std::move(canvas).finish();
}

}  // namespace traverse::render
