#pragma once

#include "plot/plot_area.hpp"

namespace traverse::render {

/// A dashed line across `area` at a value to compare with; none if the value is not finite.
void draw_level_line(Canvas& canvas, const PlotArea& area, double value);

}  // namespace traverse::render
