#pragma once

#include <cstddef>
#include <span>

#include "traverse/geometry/trajectory.hpp"
#include "traverse/render/caption.hpp"
#include "traverse/render/drawing.hpp"
#include "traverse/render/pictures/map_from_above.hpp"
#include "traverse/render/style.hpp"

namespace traverse::render {

/// Points of a scan that were registered on lines of a map, or on planes.
struct Matches {
  MapPoints points;
  /// One a match, metres: from the nearest point of the line or plane to the scan's point.
  std::span<const float> offset_x, offset_y, offset_z;

  std::size_t size() const { return points.x.size(); }
};

/// A scan under its estimated pose, and those of its points that were registered.
struct RegisteredScan {
  MapPoints scan;
  Matches on_lines, on_planes;
};

/// From above, true to scale: the scan in grey, its matches in the colours of the features that
/// lines and planes are found by, each with its residual as a line many times as long, so that a
/// pull to one side is seen. Holds what lies within 50 m of the middle of `way` (T_map_body), which
/// is drawn in it. \throws std::invalid_argument if the arrays do not agree in size.
Drawing scan_matches(const RegisteredScan& registered, const geometry::Trajectory& way,
                     const Caption& caption, const Style& style);

}  // namespace traverse::render
