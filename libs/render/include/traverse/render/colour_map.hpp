#pragma once

#include "traverse/render/colour.hpp"

namespace traverse::render {

/// From a number to a colour.
enum class ColourMap {
  kViridis,    ///< perceptually uniform, dark violet to yellow: heights, errors, times
  kCividis,    ///< the same for every kind of colour vision, dark blue to yellow: intensities
  kDiverging,  ///< blue, white at the middle, orange: residuals with a sign
};

/// The colour at `share` of the map's length, clamped to [0, 1]; NaN takes the middle of grey.
Colour colour_at(ColourMap map, double share);

}  // namespace traverse::render
