#include "plot/scale_bar.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "plot/number_text.hpp"

namespace traverse::render {

std::string length_text(double metres) {
  if (metres >= 1000) return fixed_text(metres / 1000, 0) + " km";
  if (metres >= 1) return fixed_text(metres, 0) + " m";
  if (metres >= 0.01) return fixed_text(metres * 100, 0) + " cm";
  return value_text(metres, 1) + " m";
}

void draw_scale_bar(Canvas& canvas, const PlotArea& area, const Occupancy& occupancy) {
  const Sizes& sizes = canvas.sizes();
  const double metres = nice_step_at_most(area.x.range.span() / 6);
  const double length = metres * area.pixels_per_x();
  const std::string label = length_text(metres);
  const double width = std::max(length, canvas.width_of(label, sizes.tick)) + 2 * sizes.gap;
  const double height = Sizes::line_height(sizes.tick) + 3 * sizes.gap;
  const Rect inside = area.rect.inset(sizes.gap);
  if (width > inside.width() || height > inside.height()) return;

  const std::array<Point, 4> corners{Point{inside.right - width, inside.bottom - height},
                                     Point{inside.left, inside.bottom - height},
                                     Point{inside.right - width, inside.top},
                                     Point{inside.left, inside.top}};
  const auto room_at = [&](Point corner) {
    return Rect{corner.x, corner.y, corner.x + width, corner.y + height};
  };
  const Point best = *std::min_element(corners.begin(), corners.end(), [&](Point a, Point b) {
    return occupancy.share(room_at(a)) < occupancy.share(room_at(b));
  });
  const Rect room = room_at(best);

  const double y = std::round(room.bottom - sizes.gap);
  const double left = std::round(room.centre().x - length / 2);
  const double right = left + length;
  const double serif = 0.75 * sizes.gap;
  for (const bool edge : {true, false}) {  // the edge lifts the bar off a map
    const Colour colour = edge ? canvas.theme().background : canvas.theme().text;
    const double thick = edge ? 2.2 * sizes.line : sizes.line;
    const double more = edge ? 0.6 * sizes.line : 0;
    canvas.straight({left - more, y}, {right + more, y}, colour, thick);
    for (const double x : {left, right}) {
      canvas.straight({x, y - serif - more}, {x, y + more}, colour, thick);
    }
  }
  const Text text =
      canvas.note(label, {room.centre().x, y - 1.2 * sizes.gap}, HorizontalAlign::kCentre);
  canvas.text(canvas.on_data(coloured(text, canvas.theme().text)));
  canvas.reserve(room);
}

}  // namespace traverse::render
