#pragma once

#include <optional>

#include "plot/canvas.hpp"

namespace traverse::render {

/// Signs on a path, all with an edge in the background's colour that lifts them off the line.
/// `direction` is a unit vector along the path.
void draw_start(Canvas& canvas, Point at, Colour colour);  ///< a disc
void draw_end(Canvas& canvas, Point at, Colour colour);    ///< an open square, larger than the disc
void draw_tick(Canvas& canvas, Point at, Point direction, Colour colour);   ///< a short cross line
void draw_arrow(Canvas& canvas, Point at, Point direction, Colour colour);  ///< an arrow head

}  // namespace traverse::render
