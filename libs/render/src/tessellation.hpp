#pragma once

#include <vector>

#include "traverse/render/drawing.hpp"

#include "gl/shape_pass.hpp"

namespace traverse::render {

/// The triangles that cover a shape, appended three vertices each. Triangles of one shape may
/// overlap: they have its colour, and lines are opaque.
void tessellate(const Polyline& line, std::vector<ShapeVertex>& triangles);
void tessellate(const Polygon& polygon, std::vector<ShapeVertex>& triangles);
void tessellate(const Disc& disc, std::vector<ShapeVertex>& triangles);

}  // namespace traverse::render
