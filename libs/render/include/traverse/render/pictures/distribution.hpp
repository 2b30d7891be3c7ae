#pragma once

#include <span>
#include <string>

#include "traverse/render/caption.hpp"
#include "traverse/render/drawing.hpp"
#include "traverse/render/style.hpp"

namespace traverse::render {

/// Numbers whose distribution is shown. Those that are not finite are left out.
struct Sampled {
  std::span<const double> values;
  std::string name;  ///< "APE, translation"
  std::string unit;  ///< "m"
};

/// Histogram and, below it over the same axis, the share of values up to each; with the median and
/// the 95th percentile marked in both. A long tail is cut off, and the picture says how much.
Drawing distribution(const Sampled& sampled, const Caption& caption, const Style& style);

}  // namespace traverse::render
