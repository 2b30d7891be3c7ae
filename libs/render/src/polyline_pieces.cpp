#include "polyline_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace traverse::render {

namespace {

constexpr double kSamePoint = 0.05;      // pixels: nearer, a vertex changes nothing visible
constexpr double kShortestDash = 0.1;    // pixels
constexpr double kFarOutside = 200'000;  // pixels: beyond any picture, and still exact in a float

double distance(Point a, Point b) { return std::hypot(b.x - a.x, b.y - a.y); }

LinePiece::Vertex between(const LinePiece::Vertex& a, const LinePiece::Vertex& b, double share) {
  return {a.point + share * (b.point - a.point), mix(a.colour, b.colour, share)};
}

}  // namespace

std::vector<LinePiece> continuous_pieces(const Polyline& line) {
  std::vector<LinePiece> pieces;
  bool whole = true;
  bool open = false;  // whether the last piece goes on
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    Point point = line.points[i];
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) {
      open = whole = false;
      continue;
    }
    point = {std::clamp(point.x, -kFarOutside, kFarOutside),
             std::clamp(point.y, -kFarOutside, kFarOutside)};
    if (!std::exchange(open, true)) pieces.emplace_back();
    auto& vertices = pieces.back().vertices;
    const Colour colour = line.colours.empty() ? line.colour : line.colours.at(i);
    if (vertices.empty() || distance(vertices.back().point, point) > kSamePoint) {
      vertices.push_back({point, colour});
    }
  }
  if (line.closed && whole && !pieces.empty()) pieces.front().closed = true;
  return pieces;
}

std::vector<LinePiece> dashed(const LinePiece& piece, const std::vector<double>& dashes) {
  const bool usable = !dashes.empty() && std::all_of(dashes.begin(), dashes.end(),
                                                     [](double d) { return d >= kShortestDash; });
  if (!usable) return {piece};
  std::vector<LinePiece::Vertex> path = piece.vertices;
  if (piece.closed && !path.empty()) path.push_back(path.front());

  std::vector<LinePiece> cut;
  std::size_t phase = 0;  // even: drawn
  double left = dashes.front();
  if (!path.empty()) cut.push_back({{path.front()}, false});
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double length = distance(path[i - 1].point, path[i].point);
    double done = 0;
    while (length - done > left) {
      done += left;
      const LinePiece::Vertex here = between(path[i - 1], path[i], done / length);
      const bool was_drawn = phase % 2 == 0;
      if (was_drawn) {
        cut.back().vertices.push_back(here);
      } else {
        cut.push_back({{here}, false});
      }
      left = dashes[++phase % dashes.size()];
    }
    left -= length - done;
    if (phase % 2 == 0) cut.back().vertices.push_back(path[i]);
  }
  return cut;
}

}  // namespace traverse::render
