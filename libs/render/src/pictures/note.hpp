#pragma once

#include <string>

#include "plot/canvas.hpp"

namespace traverse::render {

/// Says in `room` why there is nothing to see; in its upper part, where it hides no path.
void draw_note(Canvas& canvas, const Rect& room, const std::string& text);

}  // namespace traverse::render
