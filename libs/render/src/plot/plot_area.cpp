#include "plot/plot_area.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::render {

namespace {

/// Ticks may be as near as this many text heights (up the page) or label widths (across).
constexpr double kVerticalSpacing = 2.8;
constexpr double kHorizontalSpacing = 2.2;
constexpr int kMostTicks = 12;

int max_ticks_up(const Canvas& canvas, double height) {
  return std::clamp(static_cast<int>(height / (kVerticalSpacing * canvas.sizes().tick)), 2,
                    kMostTicks);
}

int max_ticks_across(const Canvas& canvas, const Axis& x, double width) {
  const Notation notation = Notation::for_range(x.range);
  double widest = 2 * canvas.sizes().tick;
  for (const std::string& label : tick_labels(nice_ticks(x.range, kMostTicks), notation)) {
    widest = std::max(widest, canvas.width_of(label, canvas.sizes().tick));
  }
  return std::clamp(static_cast<int>(width / (kHorizontalSpacing * widest)), 2, kMostTicks);
}

Ticks ticks_of(const Axis& axis, int at_most) {
  const Ticks ticks = nice_ticks(axis.range, at_most);
  return axis.whole_numbers && ticks.step < 1 ? ticks_of_step(axis.range, 1) : ticks;
}

double widest_label(const Canvas& canvas, const Ticks& ticks, const Notation& notation) {
  double widest = 0;
  for (const std::string& label : tick_labels(ticks, notation)) {
    widest = std::max(widest, canvas.width_of(label, canvas.sizes().tick));
  }
  return widest;
}

/// Drawable range: never empty, never infinite.
Range usable(Range range) {
  if (!std::isfinite(range.span())) return {};
  if (range.span() > 0) return range;
  const double room = range.low == 0 ? 1 : 0.1 * std::abs(range.low);
  return {range.low - room, range.high + room};
}

double header_height(const Canvas& canvas) {
  return Sizes::line_height(canvas.sizes().body) + canvas.sizes().gap;
}

/// The inside of `outer`, which keeps a usable size even when there is no room for the margins.
Rect inner_rect(const Canvas& canvas, const Rect& outer, const PlotMargins& margins) {
  Rect inner = outer;
  inner.left += margins.left;
  inner.right -= canvas.sizes().tick;  // half of the last number
  if (margins.header) inner.top += header_height(canvas);
  if (margins.x_labels) inner.bottom -= x_label_height(canvas);
  inner.right = std::max(inner.right, inner.left + 10);
  inner.bottom = std::max(inner.bottom, inner.top + 10);
  return {std::round(inner.left), std::round(inner.top), std::round(inner.right),
          std::round(inner.bottom)};
}

void draw_x_labels(Canvas& canvas, const PlotArea& area) {
  const Sizes& sizes = canvas.sizes();
  const double baseline = area.rect.bottom + sizes.gap + sizes.tick;
  const std::vector<std::string> labels = tick_labels(area.x_ticks, area.x_notation);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    canvas.text(canvas.note(labels[i], {area.x_at(area.x_ticks.values[i]), baseline},
                            HorizontalAlign::kCentre));
  }
  const std::string name = area.x_notation.axis_label(area.x.name, area.x.unit);
  canvas.text(canvas.body(canvas.fitted(name, sizes.body, area.rect.width()),
                          {area.rect.centre().x, x_name_baseline(canvas, area)},
                          HorizontalAlign::kCentre));
}

void draw_y_labels(Canvas& canvas, const PlotArea& area) {
  const Sizes& sizes = canvas.sizes();
  const std::vector<std::string> labels = tick_labels(area.y_ticks, area.y_notation);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const double middle = area.y_at(area.y_ticks.values[i]);
    canvas.text(canvas.note(labels[i],
                            {area.rect.left - sizes.gap, middle + kHalfDigit * sizes.tick},
                            HorizontalAlign::kRight));
  }
}

}  // namespace

double header_baseline(const Canvas& canvas, const PlotArea& area) {
  return area.rect.top - canvas.sizes().gap - 0.15 * canvas.sizes().body;
}

double x_name_baseline(const Canvas& canvas, const PlotArea& area) {
  const Sizes& sizes = canvas.sizes();
  return area.rect.bottom + sizes.gap + sizes.tick + Sizes::line_height(sizes.body);
}

double x_label_height(const Canvas& canvas) {
  return Sizes::line_height(canvas.sizes().tick) + Sizes::line_height(canvas.sizes().body) +
         canvas.sizes().gap;
}

double room_for_y_labels(const Canvas& canvas, const Axis& y, double height) {
  Axis axis = y;
  axis.range = usable(y.range);
  const Ticks ticks = ticks_of(axis, max_ticks_up(canvas, height));
  return widest_label(canvas, ticks, Notation::for_range(axis.range)) + canvas.sizes().gap;
}

PlotArea lay_out(const Canvas& canvas, const Rect& outer, const Axis& x, const Axis& y,
                 const PlotMargins& margins) {
  PlotArea area;
  area.x = x;
  area.y = y;
  area.x.range = usable(x.range);
  area.y.range = usable(y.range);
  PlotMargins all = margins;
  all.left = std::max(margins.left, room_for_y_labels(canvas, y, outer.height()));
  area.rect = inner_rect(canvas, outer, all);
  area.x_notation = Notation::for_range(area.x.range);
  area.y_notation = Notation::for_range(area.y.range);
  area.x_ticks = ticks_of(area.x, max_ticks_across(canvas, area.x, area.rect.width()));
  area.y_ticks = ticks_of(area.y, max_ticks_up(canvas, area.rect.height()));
  return area;
}

PlotArea lay_out_equal(const Canvas& canvas, const Rect& outer, const Axis& x, const Axis& y) {
  PlotArea area;
  area.x = {x.name, x.unit, usable(x.range)};
  area.y = {y.name, y.unit, usable(y.range)};
  // The room for the numbers depends on the ranges, which grow with the room that is left.
  double room = 3 * canvas.sizes().tick;
  for (int pass = 0; pass < 2; ++pass) {
    PlotMargins margins;
    margins.left = room;
    area.rect = inner_rect(canvas, outer, margins);
    const double unit = std::max(usable(x.range).span() / area.rect.width(),
                                 usable(y.range).span() / area.rect.height());
    area.x.range = usable(x.range).at_least(unit * area.rect.width());
    area.y.range = usable(y.range).at_least(unit * area.rect.height());
    area.x_notation = Notation::for_range(area.x.range);
    area.y_notation = Notation::for_range(area.y.range);
    const Ticks x_ticks =
        nice_ticks(area.x.range, max_ticks_across(canvas, area.x, area.rect.width()));
    const Ticks y_ticks = nice_ticks(area.y.range, max_ticks_up(canvas, area.rect.height()));
    // The same for both, so that the grid's cells are squares; not where a narrow axis would
    // be left without.
    const double step = std::max(x_ticks.step, y_ticks.step);
    area.x_ticks = ticks_of_step(area.x.range, step);
    area.y_ticks = ticks_of_step(area.y.range, step);
    if (area.x_ticks.values.size() < 2) area.x_ticks = x_ticks;
    if (area.y_ticks.values.size() < 2) area.y_ticks = y_ticks;
    room = widest_label(canvas, area.y_ticks, area.y_notation) + canvas.sizes().gap;
  }
  return area;
}

void draw_axes(Canvas& canvas, const PlotArea& area, const PlotMargins& margins) {
  const Sizes& sizes = canvas.sizes();
  const Theme& theme = canvas.theme();
  for (const double value : area.x_ticks.values) {
    const double x = area.x_at(value);
    canvas.straight({x, area.rect.top}, {x, area.rect.bottom}, theme.grid, sizes.hairline);
  }
  for (const double value : area.y_ticks.values) {
    const double y = area.y_at(value);
    canvas.straight({area.rect.left, y}, {area.rect.right, y}, theme.grid, sizes.hairline);
  }
  if (margins.header) {
    const std::string name = area.y_notation.axis_label(area.y.name, area.y.unit);
    canvas.text(canvas.body(canvas.fitted(name, sizes.body, area.rect.width()),
                            {area.rect.left, header_baseline(canvas, area)}));
  }
  draw_y_labels(canvas, area);
  if (margins.x_labels) draw_x_labels(canvas, area);
}

}  // namespace traverse::render
