#pragma once

#include <span>
#include <vector>

#include "traverse/render/rect.hpp"

namespace traverse::render {

/// A line through fewer points that looks the same: of the points that follow one another in one
/// column of pixels, the first, the lowest, the highest and the last stay, in their order. So a
/// peak of a single sample survives. Points that are not finite stay, for they are gaps.
std::vector<Point> decimated(std::span<const Point> points, double column_width = 1);

}  // namespace traverse::render
