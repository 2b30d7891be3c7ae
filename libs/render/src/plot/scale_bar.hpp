#pragma once

#include "plot/canvas.hpp"
#include "plot/occupancy.hpp"
#include "plot/plot_area.hpp"

namespace traverse::render {

/// A bar of a round length in metres, in the corner of `area` that carries the least data. Of equal
/// axes only.
void draw_scale_bar(Canvas& canvas, const PlotArea& area, const Occupancy& occupancy);

/// "500 m", "2 km", "20 cm".
std::string length_text(double metres);

}  // namespace traverse::render
