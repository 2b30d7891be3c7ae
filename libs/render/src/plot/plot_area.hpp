#pragma once

#include <string>

#include "traverse/render/plot/range.hpp"

#include "plot/canvas.hpp"
#include "plot/ticks.hpp"

namespace traverse::render {

/// What stands along an axis.
struct Axis {
  std::string name;  ///< "x"
  std::string unit;  ///< "m"; empty for none
  Range range;
  bool whole_numbers = false;  ///< no ticks between them
};

/// A pair of axes and the rectangle that they span in the picture.
struct PlotArea {
  Rect rect;
  Axis x;
  Axis y;
  Ticks x_ticks;
  Ticks y_ticks;
  Notation x_notation;
  Notation y_notation;

  double x_at(double value) const {
    return rect.left + (value - x.range.low) / x.range.span() * rect.width();
  }
  double y_at(double value) const {
    return rect.bottom - (value - y.range.low) / y.range.span() * rect.height();
  }
  Point at(double x_value, double y_value) const { return {x_at(x_value), y_at(y_value)}; }

  double pixels_per_x() const { return rect.width() / x.range.span(); }
  double pixels_per_y() const { return rect.height() / y.range.span(); }
};

/// What a plot area leaves room for inside its outer rectangle.
struct PlotMargins {
  bool header = true;    ///< a line above, for the y axis' name and the legend
  bool x_labels = true;  ///< numbers and name below
  double left = 0;       ///< at least that much for the numbers of the y axis
};

/// Axes of independent scales in `outer`.
PlotArea lay_out(const Canvas& canvas, const Rect& outer, const Axis& x, const Axis& y,
                 const PlotMargins& margins = {});

/// Axes of equal scale, with ticks of the same step where both then have some: the ranges grow
/// until they fill `outer`.
PlotArea lay_out_equal(const Canvas& canvas, const Rect& outer, const Axis& x, const Axis& y);

/// Height of the numbers and the name of an x axis.
double x_label_height(const Canvas& canvas);

/// Room that the numbers of a y axis need to the left of an area `height` high.
double room_for_y_labels(const Canvas& canvas, const Axis& y, double height);

/// Baselines of the lines above an area (its y axis' name) and below it (its x axis' name).
double header_baseline(const Canvas& canvas, const PlotArea& area);
double x_name_baseline(const Canvas& canvas, const PlotArea& area);

/// Grid lines and the numbers at them, and the names of the axes: x below, y above. No frame.
void draw_axes(Canvas& canvas, const PlotArea& area, const PlotMargins& margins = {});

}  // namespace traverse::render
