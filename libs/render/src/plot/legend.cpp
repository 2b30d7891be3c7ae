#include "plot/legend.hpp"

#include <algorithm>
#include <numeric>

#include "plot/markers.hpp"

namespace traverse::render {

namespace {

constexpr double kMostShare = 0.25;  // of a plot's height

double sample_width(const Sizes& sizes, Sample sample) {
  return sample == Sample::kLine || sample == Sample::kDashedLine ? 2.2 * sizes.body
                                                                  : 1.0 * sizes.body;
}

double entry_width(const Canvas& canvas, const LegendEntry& entry) {
  const Sizes& sizes = canvas.sizes();
  return sample_width(sizes, entry.sample) + 0.7 * sizes.gap +
         canvas.width_of(entry.label, sizes.body);
}

double between_entries(const Sizes& sizes) { return 2.5 * sizes.gap; }

/// How many entries stand in each row.
std::vector<std::size_t> rows_of(const Canvas& canvas, const std::vector<LegendEntry>& entries,
                                 double width) {
  std::vector<std::size_t> rows;
  double used = 0;
  for (const LegendEntry& entry : entries) {
    const double wide = entry_width(canvas, entry);
    if (rows.empty() || used + between_entries(canvas.sizes()) + wide > width) {
      rows.push_back(0);
      used = -between_entries(canvas.sizes());
    }
    ++rows.back();
    used += between_entries(canvas.sizes()) + wide;
  }
  return rows;
}

void draw_sample(Canvas& canvas, const LegendEntry& entry, double left, double middle) {
  const Sizes& sizes = canvas.sizes();
  const double width = sample_width(sizes, entry.sample);
  const Point centre{left + width / 2, middle};
  switch (entry.sample) {
    case Sample::kLine:
    case Sample::kDashedLine: {
      Polyline line;
      line.points = {{left, middle}, {left + width, middle}};
      line.colour = entry.colour;
      line.width = 1.3 * sizes.line;
      line.cap = LineCap::kButt;
      if (entry.sample == Sample::kDashedLine) {
        line.width = sizes.line;
        line.dashes = reference_dashes(sizes);
      }
      canvas.add(std::move(line));
      break;
    }
    case Sample::kPoint:
      canvas.add(Disc{centre, 0.3 * sizes.body, entry.colour, 1});
      break;
    case Sample::kSwatch:
      canvas.fill(Rect{left, middle - 0.4 * sizes.body, left + width, middle + 0.4 * sizes.body},
                  entry.colour);
      break;
    case Sample::kStart:
      draw_start(canvas, centre, entry.colour);
      break;
    case Sample::kEnd:
      draw_end(canvas, centre, entry.colour);
      break;
    case Sample::kTick:
      draw_tick(canvas, centre, {1, 0}, entry.colour);
      break;
    case Sample::kArrow:
      draw_arrow(canvas, centre, {1, 0}, entry.colour);
      break;
  }
}

void draw_entry(Canvas& canvas, const LegendEntry& entry, double left, double baseline) {
  const Sizes& sizes = canvas.sizes();
  const double width = sample_width(sizes, entry.sample);
  const Rect sample{left, baseline - 0.7 * sizes.body, left + width, baseline};
  const Text label = canvas.body(entry.label, {left + width + 0.7 * sizes.gap, baseline});
  if (!canvas.is_free(sample) || !canvas.text(label)) return;
  canvas.reserve(sample);
  draw_sample(canvas, entry, left, baseline - kHalfDigit * sizes.body);
}

}  // namespace

std::vector<double> reference_dashes(const Sizes& sizes) {
  return {4 * sizes.line, 2.5 * sizes.line};
}

double legend_height(const Canvas& canvas, const std::vector<LegendEntry>& entries, double width) {
  return static_cast<double>(rows_of(canvas, entries, width).size()) *
         Sizes::line_height(canvas.sizes().body);
}

void draw_legend(Canvas& canvas, const std::vector<LegendEntry>& entries, const Rect& room) {
  const Sizes& sizes = canvas.sizes();
  double baseline = room.top + 1.2 * sizes.body;
  std::size_t next = 0;
  for (const std::size_t count : rows_of(canvas, entries, room.width())) {
    if (baseline > room.bottom) return;
    const auto first = entries.begin() + static_cast<std::ptrdiff_t>(next);
    const double width =
        std::accumulate(first, first + static_cast<std::ptrdiff_t>(count), -between_entries(sizes),
                        [&](double sum, const LegendEntry& entry) {
                          return sum + between_entries(sizes) + entry_width(canvas, entry);
                        });
    double left = std::max(room.left, room.right - width);
    for (std::size_t i = 0; i < count; ++i, ++next) {
      draw_entry(canvas, entries[next], left, baseline);
      left += entry_width(canvas, entries[next]) + between_entries(sizes);
    }
    baseline += Sizes::line_height(sizes.body);
  }
}

Rect draw_legend_above(Canvas& canvas, const std::vector<LegendEntry>& entries, const Rect& outer,
                       const std::string& y_name) {
  const Sizes& sizes = canvas.sizes();
  Rect room = outer;
  room.left += canvas.width_of(y_name, sizes.body) + 2 * between_entries(sizes);
  room.right -= sizes.tick;
  const double row = Sizes::line_height(sizes.body);
  const double height =
      std::min(legend_height(canvas, entries, room.width()), kMostShare * outer.height());
  room.bottom = room.top + std::max(row, height);
  draw_legend(canvas, entries, room);
  Rect below = outer;
  below.top = std::max(below.top, room.bottom - row);
  return below;
}

}  // namespace traverse::render
