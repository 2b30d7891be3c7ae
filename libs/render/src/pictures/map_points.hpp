#pragma once

#include <vector>

#include "traverse/render/pictures/map_from_above.hpp"

#include "plot/colour_scale.hpp"

namespace traverse::render {

inline constexpr double kDepthShading = 0.35;  ///< of points, where others lie near before them

/// The colour scale in the map frame's terms: heights are given from the origin.
ColourScale scale_of(const MapPoints& points, const PointValues& values);

/// The finite points in a frame with its origin at `centre` (map frame), coloured.
std::vector<ScenePoint> coloured_points(const MapPoints& points, const PointValues& values,
                                        const ColourScale& scale, const Eigen::Vector3d& centre);

/// \throws std::invalid_argument unless the arrays agree in size.
void check_sizes(const MapPoints& points, const PointValues& values);

}  // namespace traverse::render
