#pragma once

#include <span>

#include "traverse/render/colour_map.hpp"
#include "traverse/render/plot/range.hpp"

namespace traverse::render {

/// Values as colours. The colours span the 2nd to the 98th percentile, so that single extreme
/// values do not make all others look the same; what lies outside takes the colour of the end.
struct ColourScale {
  ColourMap map = ColourMap::kViridis;
  Range shown;  ///< that the colours span
  Range data;   ///< of all values
  bool clipped() const { return data.low < shown.low || data.high > shown.high; }

  Colour operator()(double value) const {
    return colour_at(map, (value - shown.low) / shown.span());
  }
};

/// The scale for `values`; a diverging map is made symmetrical about zero.
ColourScale colour_scale(std::span<const double> values, ColourMap map);
ColourScale colour_scale(std::span<const float> values, ColourMap map);

}  // namespace traverse::render
