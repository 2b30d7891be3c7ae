#pragma once

#include "traverse/geodesy/local_tangent_plane.hpp"
#include "traverse/geometry/trajectory.hpp"
#include "traverse/pipeline/run_folder.hpp"

namespace traverse::pipeline {

/// The path on the WGS84 ellipsoid, as a table (path.csv: stamp, latitude and longitude in degrees,
/// height above the ellipsoid in metres) and as a line for maps (path.kml; on the ground, because
/// KML's heights are above the sea). \param origin  of the map, a tangent plane with x east and y
/// north \throws files::OutputError
void write_geodetic_path(const geometry::Trajectory& T_map_body, const geodesy::Geodetic& origin,
                         const RunFolder& folder);

}  // namespace traverse::pipeline
