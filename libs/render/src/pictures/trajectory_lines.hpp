#pragma once

#include <vector>

#include "plot/canvas.hpp"
#include "plot/path.hpp"
#include "plot/plot_area.hpp"

namespace traverse::render {

/// Axes of equal scale that hold all `paths` from above, with some room around.
PlotArea lay_out_from_above(const Canvas& canvas, const Rect& outer,
                            const std::vector<const Path*>& paths);

/// The lines of an estimate and of the reference. The reference goes on top: where the two agree,
/// its dashes on the estimate's wider line show both.
void draw_estimate(Canvas& canvas, const PlotArea& area, std::vector<Point> line, Colour colour);
void draw_reference(Canvas& canvas, const PlotArea& area, std::vector<Point> line);

}  // namespace traverse::render
