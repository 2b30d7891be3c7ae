#pragma once

#include <string>

#include "traverse/geodesy/local_tangent_plane.hpp"
#include "traverse/geodesy/map_grid.hpp"

namespace traverse::exports {

/// A grid of WGS 84 with heights above the ellipsoid, as well-known text of the first kind (OGC
/// 01-009), which LAS 1.4 asks for: a compound of the projection and a vertical system whose datum
/// is of type 2002, ellipsoidal.
std::string grid_wkt(const geodesy::MapGrid& grid);

/// East, north and up at an origin, which is in the name; without one a frame that is tied to no
/// place on earth. First kind of well-known text too.
std::string local_wkt(const geodesy::Geodetic& origin);
std::string local_wkt();

/// "WGS 84 / UTM zone 32N"
std::string name_of(const geodesy::MapGrid& grid);

}  // namespace traverse::exports
