#pragma once

#include <filesystem>

#include "traverse/geodesy/local_tangent_plane.hpp"

namespace traverse::mapping {

/// Where on earth a map is whose frame is a local tangent plane (x east, y north, z up), as JSON:
/// {"frame": "ENU", "datum": "WGS84", "latitude_deg", "longitude_deg", "altitude_m" (above the
/// ellipsoid)}. \throws files::OutputError
void write_map_origin(const std::filesystem::path& file, const geodesy::Geodetic& origin);

/// \throws files::InputError
geodesy::Geodetic read_map_origin(const std::filesystem::path& file);

}  // namespace traverse::mapping
