#include "plot/north_arrow.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace traverse::render {

namespace {

constexpr double kLeastHorizontal = 0.1;  // of the length: else the map is seen along north

/// The free corner of `inside` for a square of `side` that hides the least.
std::optional<Rect> room_in(const Canvas& canvas, const Rect& inside, double side,
                            const Occupancy& occupancy) {
  if (side > inside.width() || side > inside.height()) return std::nullopt;
  std::optional<Rect> best;
  for (const double x : {inside.right - side, inside.left}) {
    for (const double y : {inside.top, inside.bottom - side}) {
      const Rect room{x, y, x + side, y + side};
      if (!canvas.is_free(room)) continue;
      if (!best || occupancy.share(room) < occupancy.share(*best)) best = room;
    }
  }
  return best;
}

}  // namespace

void draw_north_arrow(Canvas& canvas, const PlotArea& area, const Eigen::Vector3d& north,
                      const Occupancy& occupancy) {
  if (north.head<2>().norm() < kLeastHorizontal) return;
  const Eigen::Vector2d unit = north.head<2>().normalized();
  const Sizes& sizes = canvas.sizes();
  const auto room = room_in(canvas, area.rect.inset(sizes.gap), 5 * sizes.tick, occupancy);
  if (!room) return;

  const Point ahead{unit.x(), -unit.y()};  // y of pictures points down
  const Point side{-ahead.y, ahead.x};
  const double length = 1.4 * sizes.tick;  // from the middle to the tip
  const double width = 0.65 * sizes.tick;
  // The letter stands at the tip: arrow and letter together are in the middle of the room.
  const Point middle = room->centre() - 0.6 * sizes.tick * ahead;
  const Point tip = middle + length * ahead;
  const Point notch = middle - 0.5 * length * ahead;
  for (const double hand : {1.0, -1.0}) {
    const Point wing = middle - length * ahead + hand * width * side;
    Polygon half{{tip, wing, notch}, canvas.theme().text, 1};
    if (hand < 0) half.fill = canvas.theme().muted;
    Polyline edge;
    edge.points = half.corners;
    edge.closed = true;
    edge.colour = canvas.theme().background;
    edge.width = 1.2 * sizes.line;
    canvas.add(std::move(edge));
    canvas.add(std::move(half));
  }
  const Point letter = middle + (length + 0.8 * sizes.tick) * ahead;
  Text text =
      canvas.note("N", {letter.x, letter.y + kHalfDigit * sizes.tick}, HorizontalAlign::kCentre);
  text.weight = FontWeight::kBold;
  canvas.text(canvas.on_data(coloured(text, canvas.theme().text)));
  canvas.reserve(*room);
}

}  // namespace traverse::render
