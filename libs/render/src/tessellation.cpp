#include "tessellation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "polyline_pieces.hpp"

namespace traverse::render {

namespace {

constexpr double kHalfTurn = std::numbers::pi;  // radians
constexpr double kChordError = 0.05;            // pixels between an arc and the chord drawn for it

ShapeVertex vertex(Point p, Colour colour, double opacity = 1) {
  return {static_cast<float>(p.x),
          static_cast<float>(p.y),
          colour.red,
          colour.green,
          colour.blue,
          static_cast<std::uint8_t>(std::lround(255 * std::clamp(opacity, 0.0, 1.0)))};
}

/// The largest angle whose chord stays within kChordError of the arc.
double arc_step(double radius) {
  return 2 * std::acos(std::clamp(1 - kChordError / radius, 0.0, 1.0));
}

Point on_circle(Point centre, double radius, double angle) {
  return {centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)};
}

void add_sector(Point centre, double radius, double from_angle, double to_angle, Colour colour,
                double opacity, std::vector<ShapeVertex>& triangles) {
  const int steps =
      std::max(1, static_cast<int>(std::ceil(std::abs(to_angle - from_angle) / arc_step(radius))));
  Point previous = on_circle(centre, radius, from_angle);
  for (int i = 1; i <= steps; ++i) {
    const Point next = on_circle(centre, radius, from_angle + (to_angle - from_angle) * i / steps);
    for (const Point corner : {centre, previous, next}) {
      triangles.push_back(vertex(corner, colour, opacity));
    }
    previous = next;
  }
}

double direction(Point from, Point to) { return std::atan2(to.y - from.y, to.x - from.x); }

/// Draws one piece: a quadrilateral a segment, a sector outside each bend, and the ends.
class Ribbon {
 public:
  Ribbon(const LinePiece& piece, double half_width, std::vector<ShapeVertex>& triangles)
      : vertices_(piece.vertices),
        closed_(piece.closed && piece.vertices.size() > 2),
        half_width_(half_width),
        triangles_(triangles) {}

  void add(LineCap cap) {
    const std::size_t count = vertices_.size();
    if (count == 1) {
      if (cap == LineCap::kRound) add_end(0, 0, 2 * kHalfTurn);
      return;
    }
    for (std::size_t i = 1; i < count; ++i) add_segment(i - 1, i);
    for (std::size_t i = 1; i + 1 < count; ++i) add_join(i - 1, i, i + 1);
    if (closed_) {
      add_segment(count - 1, 0);
      add_join(count - 2, count - 1, 0);
      add_join(count - 1, 0, 1);
    } else if (cap == LineCap::kRound) {
      const double first = direction(vertices_[0].point, vertices_[1].point);
      add_end(0, first + kHalfTurn / 2, kHalfTurn);
      const double last = direction(vertices_[count - 2].point, vertices_[count - 1].point);
      add_end(count - 1, last - kHalfTurn / 2, kHalfTurn);
    }
  }

 private:
  void add_segment(std::size_t a, std::size_t b) {
    const Point from = vertices_[a].point;
    const Point to = vertices_[b].point;
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    const Point aside = (half_width_ / length) * Point{from.y - to.y, to.x - from.x};
    const ShapeVertex corners[4] = {
        vertex(from + aside, vertices_[a].colour), vertex(from - aside, vertices_[a].colour),
        vertex(to + aside, vertices_[b].colour), vertex(to - aside, vertices_[b].colour)};
    for (const int i : {0, 1, 2, 2, 1, 3}) triangles_.push_back(corners[i]);
  }

  void add_join(std::size_t before, std::size_t at, std::size_t after) {
    const double in = direction(vertices_[before].point, vertices_[at].point);
    const double out = direction(vertices_[at].point, vertices_[after].point);
    const double turn = std::remainder(out - in, 2 * kHalfTurn);
    const double outer_side = turn > 0 ? -kHalfTurn / 2 : kHalfTurn / 2;
    add_sector(vertices_[at].point, half_width_, in + outer_side, in + outer_side + turn,
               vertices_[at].colour, 1, triangles_);
  }

  void add_end(std::size_t at, double from_angle, double sweep) {
    add_sector(vertices_[at].point, half_width_, from_angle, from_angle + sweep,
               vertices_[at].colour, 1, triangles_);
  }

  const std::vector<LinePiece::Vertex>& vertices_;
  bool closed_;
  double half_width_;
  std::vector<ShapeVertex>& triangles_;
};

bool finite(Point p) { return std::isfinite(p.x) && std::isfinite(p.y); }

}  // namespace

void tessellate(const Polyline& line, std::vector<ShapeVertex>& triangles) {
  if (!(line.width > 0)) return;
  for (const LinePiece& piece : continuous_pieces(line)) {
    for (const LinePiece& dash : dashed(piece, line.dashes)) {
      Ribbon(dash, line.width / 2, triangles).add(line.cap);
    }
  }
}

void tessellate(const Polygon& polygon, std::vector<ShapeVertex>& triangles) {
  const auto& corners = polygon.corners;
  if (!std::all_of(corners.begin(), corners.end(), finite)) return;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    for (const Point corner : {corners[0], corners[i - 1], corners[i]}) {
      triangles.push_back(vertex(corner, polygon.fill, polygon.opacity));
    }
  }
}

void tessellate(const Disc& disc, std::vector<ShapeVertex>& triangles) {
  if (!finite(disc.centre) || !(disc.radius > 0)) return;
  add_sector(disc.centre, disc.radius, 0, 2 * kHalfTurn, disc.fill, disc.opacity, triangles);
}

}  // namespace traverse::render
