#pragma once

#include <vector>

#include "plot/plot_area.hpp"

namespace traverse::render {

/// Room for one of several plots that stand one below the other over a common x axis.
struct StackedPanel {
  Rect outer;
  PlotMargins margins;  ///< equal at the left; numbers of the x axis only below the lowest
};

/// Divides `room` among panels with the y axes `axes`, all equally high inside.
std::vector<StackedPanel> stacked_panels(const Canvas& canvas, const Rect& room,
                                         const std::vector<Axis>& axes);

}  // namespace traverse::render
