#pragma once

#include <string>

#include "plot/canvas.hpp"
#include "plot/colour_scale.hpp"

namespace traverse::render {

/// The key to a colour scale: a column beside a plot, with name, bar, numbers and, when values lie
/// outside, a note of it.
struct ColourBar {
  ColourScale scale;
  std::string name;  ///< "APE"
  std::string unit;  ///< "m"
};

/// Width of the column.
double colour_bar_width(const Canvas& canvas, const ColourBar& bar);

void draw_colour_bar(Canvas& canvas, const ColourBar& bar, const Rect& room);

}  // namespace traverse::render
