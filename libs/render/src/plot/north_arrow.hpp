#pragma once

#include <Eigen/Core>

#include "plot/canvas.hpp"
#include "plot/occupancy.hpp"
#include "plot/plot_area.hpp"

namespace traverse::render {

/// An arrow to true north, in the corner of `area` that carries the least data and nothing else.
/// \param north towards north in the map frame; only its horizontal part counts, and there is no
/// arrow without one
void draw_north_arrow(Canvas& canvas, const PlotArea& area, const Eigen::Vector3d& north,
                      const Occupancy& occupancy);

}  // namespace traverse::render
