#include "plot/colour_bar.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "plot/number_text.hpp"
#include "plot/ticks.hpp"
#include "plot/wrapped.hpp"

namespace traverse::render {

namespace {

constexpr int kBands = 256;
constexpr int kMostBarTicks = 8;
constexpr const char* kClipNote = "ends at 2nd and 98th percentile";

double bar_width(const Sizes& sizes) { return 1.3 * sizes.tick; }

std::string title_of(const ColourBar& bar) {
  return Notation::for_range(bar.scale.shown).axis_label(bar.name, bar.unit);
}

std::vector<std::string> notes_of(const ColourBar& bar) {
  if (!bar.scale.clipped()) return {};
  const std::string unit = bar.unit.empty() ? "" : " " + bar.unit;
  return {kClipNote, "min " + value_text(bar.scale.data.low) + unit,
          "max " + value_text(bar.scale.data.high) + unit};
}

void draw_bands(Canvas& canvas, const ColourScale& scale, const Rect& bar) {
  for (int i = 0; i < kBands; ++i) {
    const double top = bar.bottom - bar.height() * (i + 1) / kBands;
    const double bottom = bar.bottom - bar.height() * i / kBands;
    canvas.fill({bar.left, top, bar.right, bottom}, colour_at(scale.map, (i + 0.5) / kBands));
  }
}

/// Triangles beyond the ends say that there are values beyond them.
void draw_ends(Canvas& canvas, const ColourScale& scale, const Rect& bar) {
  const double height = 0.6 * bar.width();
  const double middle = bar.centre().x;
  if (scale.data.high > scale.shown.high) {
    canvas.add(Polygon{{{bar.left, bar.top}, {middle, bar.top - height}, {bar.right, bar.top}},
                       colour_at(scale.map, 1),
                       1});
  }
  if (scale.data.low < scale.shown.low) {
    canvas.add(
        Polygon{{{bar.left, bar.bottom}, {middle, bar.bottom + height}, {bar.right, bar.bottom}},
                colour_at(scale.map, 0),
                1});
  }
}

void draw_numbers(Canvas& canvas, const ColourScale& scale, const Rect& bar) {
  const Sizes& sizes = canvas.sizes();
  const int most = static_cast<int>(bar.height() / (3 * sizes.tick));
  const Ticks ticks = nice_ticks(scale.shown, std::clamp(most, 2, kMostBarTicks));
  const std::vector<std::string> labels = tick_labels(ticks, Notation::for_range(scale.shown));
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const double share = (ticks.values[i] - scale.shown.low) / scale.shown.span();
    const double y = bar.bottom - share * bar.height();
    canvas.straight({bar.right, y}, {bar.right + sizes.gap / 2, y}, canvas.theme().axis,
                    sizes.hairline);
    canvas.text(canvas.note(labels[i], {bar.right + sizes.gap, y + kHalfDigit * sizes.tick}));
  }
}

std::vector<std::string> wrapped_notes(const Canvas& canvas, const ColourBar& bar, double width) {
  std::vector<std::string> lines;
  for (const std::string& note : notes_of(bar)) {
    for (std::string& line : wrapped(canvas.measure(), note, canvas.sizes().tick, width)) {
      lines.push_back(std::move(line));
    }
  }
  return lines;
}

}  // namespace

double colour_bar_width(const Canvas& canvas, const ColourBar& bar) {
  const Sizes& sizes = canvas.sizes();
  const Ticks ticks = nice_ticks(bar.scale.shown, kMostBarTicks);
  double widest = 0;
  for (const std::string& label : tick_labels(ticks, Notation::for_range(bar.scale.shown))) {
    widest = std::max(widest, canvas.width_of(label, sizes.tick));
  }
  const double with_numbers = bar_width(sizes) + sizes.gap + widest;
  const double room_for_note = bar.scale.clipped() ? 7.5 * sizes.tick : 0;
  return std::max({with_numbers, room_for_note,
                   std::min(canvas.width_of(title_of(bar), sizes.body), 11 * sizes.body)});
}

void draw_colour_bar(Canvas& canvas, const ColourBar& bar, const Rect& room) {
  const Sizes& sizes = canvas.sizes();
  double top = room.top;
  for (const std::string& line :
       wrapped(canvas.measure(), title_of(bar), sizes.body, room.width())) {
    canvas.text(canvas.body(line, {room.left, top + 1.2 * sizes.body}));
    top += Sizes::line_height(sizes.body);
  }
  top += sizes.gap;  // in line with the top of the plot beside it

  const std::vector<std::string> notes = wrapped_notes(canvas, bar, room.width());
  const double notes_height =
      static_cast<double>(notes.size()) * Sizes::line_height(sizes.tick) + sizes.gap;
  const double ends = 0.6 * bar_width(sizes);
  const Rect column{room.left, top + ends, room.left + bar_width(sizes),
                    room.bottom - ends - notes_height};
  if (column.height() < 3 * sizes.tick) return;
  draw_bands(canvas, bar.scale, column);
  draw_ends(canvas, bar.scale, column);
  draw_numbers(canvas, bar.scale, column);

  double baseline = column.bottom + ends + sizes.gap + sizes.tick;
  for (const std::string& note : notes) {
    canvas.text(canvas.note(note, {room.left, baseline}));
    baseline += Sizes::line_height(sizes.tick);
  }
}

}  // namespace traverse::render
