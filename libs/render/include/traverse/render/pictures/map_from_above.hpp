#pragma once

#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "traverse/geometry/trajectory.hpp"
#include "traverse/render/caption.hpp"
#include "traverse/render/colour_map.hpp"
#include "traverse/render/drawing.hpp"
#include "traverse/render/style.hpp"

namespace traverse::render {

/// Points of a map. Points that are not finite are left out.
struct MapPoints {
  std::span<const float> x, y, z;                    ///< metres from `origin`
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< in the map frame, metres
};

/// What the points are coloured by.
struct PointValues {
  std::span<const float> values;  ///< one a point; empty: the height z in the map frame
  std::string name = "height z";
  std::string unit = "m";
  ColourMap map = ColourMap::kViridis;
};

/// A map from above, true to scale, with the trajectory in it; what is higher covers what is lower,
/// and edges are shaded. A few stray points far away do not shrink the rest: the picture holds the
/// trajectory and 99 % of the points. `trajectory` (T_map_body) may be null. An arrow points to
/// north, given in the map frame, if it is known.
/// \throws std::invalid_argument if the arrays do not agree in size.
Drawing map_from_above(const MapPoints& points, const PointValues& values,
                       const geometry::Trajectory* trajectory, const Caption& caption,
                       const Style& style, const std::optional<Eigen::Vector3d>& north = {});

}  // namespace traverse::render
