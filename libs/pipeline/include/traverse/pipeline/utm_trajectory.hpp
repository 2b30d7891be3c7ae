#pragma once

#include "traverse/geodesy/local_tangent_plane.hpp"
#include "traverse/geometry/trajectory.hpp"

namespace traverse::pipeline {

/// A trajectory on a UTM grid: x easting, y northing, z above the ellipsoid, metres. Rotations are
/// those in the grid's axes, which are turned from true east and north by its convergence.
struct UtmTrajectory {
  int zone = 0;
  bool is_north = true;
  geometry::Trajectory T_utm_body;
};

/// All in the zone of the origin. Distances on the grid are up to 0.04 % too short.
/// \param origin  of the map, a tangent plane with x east and y north
/// \throws std::invalid_argument for a place that the zone does not reach.
UtmTrajectory to_utm(const geometry::Trajectory& T_map_body, const geodesy::Geodetic& origin);

}  // namespace traverse::pipeline
