#pragma once

#include <string>

#include "traverse/render/caption.hpp"

#include "plot/canvas.hpp"

namespace traverse::render {

/// Writes title, provenance and statistic at the top of the page and returns the room below.
Rect draw_title_block(Canvas& canvas, const Caption& caption, const std::string& usual_title);

}  // namespace traverse::render
