#pragma once

#include "traverse/geometry/trajectory.hpp"
#include "traverse/render/caption.hpp"
#include "traverse/render/drawing.hpp"
#include "traverse/render/pictures/map_from_above.hpp"
#include "traverse/render/style.hpp"

namespace traverse::render {

/// A map seen obliquely from above, in perspective, with the trajectory in it: from the side from
/// which the way is seen broadest. Edges are shaded. The colour scale is that of map_from_above().
/// \throws std::invalid_argument if the arrays do not agree in size.
Drawing map_in_perspective(const MapPoints& points, const PointValues& values,
                           const geometry::Trajectory& trajectory, const Caption& caption,
                           const Style& style);

}  // namespace traverse::render
