#include "plot/markers.hpp"

#include <utility>

namespace traverse::render {

namespace {

Point across(Point direction) { return {-direction.y, direction.x}; }

void draw_square(Canvas& canvas, Point at, double half, double width, Colour colour) {
  Polyline square;
  square.points = {{at.x - half, at.y - half},
                   {at.x + half, at.y - half},
                   {at.x + half, at.y + half},
                   {at.x - half, at.y + half}};
  square.closed = true;
  square.colour = colour;
  square.width = width;
  canvas.add(std::move(square));
}

}  // namespace

void draw_start(Canvas& canvas, Point at, Colour colour) {
  const double line = canvas.sizes().line;
  canvas.add(Disc{at, 3.2 * line, canvas.theme().background, 1});
  canvas.add(Disc{at, 2.5 * line, colour, 1});
}

void draw_end(Canvas& canvas, Point at, Colour colour) {
  const double line = canvas.sizes().line;
  const double edge = 5.2 * line;
  canvas.fill({at.x - edge, at.y - edge, at.x + edge, at.y + edge}, canvas.theme().background);
  draw_square(canvas, at, 4 * line, 1.3 * line, colour);
}

void draw_tick(Canvas& canvas, Point at, Point direction, Colour colour) {
  const double line = canvas.sizes().line;
  const Point aside = 3.5 * line * across(direction);
  Polyline tick;
  tick.points = {at - aside, at + aside};
  tick.colour = colour;
  tick.width = line;
  tick.cap = LineCap::kButt;
  canvas.add(std::move(tick));
}

void draw_arrow(Canvas& canvas, Point at, Point direction, Colour colour) {
  const double line = canvas.sizes().line;
  const auto head = [&](double size) {
    const Point back = at - size * direction;
    return std::vector<Point>{at + size * direction, back + size * across(direction),
                              back - size * across(direction)};
  };
  canvas.add(Polygon{head(4.2 * line), canvas.theme().background, 1});
  canvas.add(Polygon{head(3.0 * line), colour, 1});
}

}  // namespace traverse::render
