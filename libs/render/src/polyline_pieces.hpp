#pragma once

#include <vector>

#include "traverse/render/drawing.hpp"

namespace traverse::render {

/// A part of a polyline that is drawn without a break.
struct LinePiece {
  struct Vertex {
    Point point;
    Colour colour;
  };
  std::vector<Vertex> vertices;
  bool closed = false;
};

/// The line cut where its points are not finite, without the points that lie on their predecessor.
std::vector<LinePiece> continuous_pieces(const Polyline& line);

/// `piece` cut into dashes: lengths drawn and left out in turn, pixels along the line. A piece
/// without dashes, or with one that could not be seen, comes back whole.
std::vector<LinePiece> dashed(const LinePiece& piece, const std::vector<double>& dashes);

}  // namespace traverse::render
