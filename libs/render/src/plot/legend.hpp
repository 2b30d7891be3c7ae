#pragma once

#include <string>
#include <vector>

#include "plot/canvas.hpp"

namespace traverse::render {

/// What a legend shows beside a label.
enum class Sample { kLine, kDashedLine, kPoint, kSwatch, kStart, kEnd, kTick, kArrow };

struct LegendEntry {
  std::string label;
  Colour colour;
  Sample sample = Sample::kLine;
};

/// Dashes of the reference, pixels.
std::vector<double> reference_dashes(const Sizes& sizes);

/// Height of the legend when it is `width` wide.
double legend_height(const Canvas& canvas, const std::vector<LegendEntry>& entries, double width);

/// Draws the entries side by side, ending at the right of `room` from its top on, in as many rows
/// as they need; entries that are still too many are left out.
void draw_legend(Canvas& canvas, const std::vector<LegendEntry>& entries, const Rect& room);

/// Draws the legend into the header line of the plot area that will be laid out in the returned
/// rectangle, beside the name of its y axis: there it hides nothing and takes no room. Further rows
/// go above.
Rect draw_legend_above(Canvas& canvas, const std::vector<LegendEntry>& entries, const Rect& outer,
                       const std::string& y_name);

}  // namespace traverse::render
