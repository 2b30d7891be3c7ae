#pragma once

#include <cmath>

namespace traverse::render {

/// A place in a picture, pixels, y down.
struct Point {
  double x = 0;
  double y = 0;

  bool operator==(const Point&) const = default;
};

inline bool is_finite(Point p) { return std::isfinite(p.x) && std::isfinite(p.y); }

inline Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
inline Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
inline Point operator*(double factor, Point p) { return {factor * p.x, factor * p.y}; }

/// A rectangle in a picture, pixels, y down; empty when right <= left or bottom <= top.
struct Rect {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;

  double width() const { return right - left; }
  double height() const { return bottom - top; }
  bool empty() const { return !(right > left && bottom > top); }
  Point centre() const { return {(left + right) / 2, (top + bottom) / 2}; }

  bool contains(Point p) const {
    return p.x >= left && p.x <= right && p.y >= top && p.y <= bottom;
  }
  bool contains(const Rect& r) const {
    return r.left >= left && r.right <= right && r.top >= top && r.bottom <= bottom;
  }
  /// Whether the two share more than an edge.
  bool overlaps(const Rect& r) const {
    return r.left < right && r.right > left && r.top < bottom && r.bottom > top;
  }
  /// Smaller by `margin` on each side; larger when it is negative.
  Rect inset(double margin) const {
    return {left + margin, top + margin, right - margin, bottom - margin};
  }

  bool operator==(const Rect&) const = default;
};

}  // namespace traverse::render
