#pragma once

#include <span>
#include <vector>

#include "traverse/render/caption.hpp"
#include "traverse/render/drawing.hpp"
#include "traverse/render/pictures/distribution.hpp"
#include "traverse/render/style.hpp"

namespace traverse::render {

/// Several distributions one below the other, each over an axis of its own: a violin (how dense the
/// values are), in it a box from the lower to the upper quartile with the median, and whiskers to
/// the 5th and 95th percentile. Density: Gaussian kernels of the width of Silverman, "Density
/// Estimation", 1986, eq. 3.31. A tail beyond the 99.5th percentile may be cut off.
Drawing violins(std::span<const Sampled> distributions, const Caption& caption, const Style& style);

}  // namespace traverse::render
