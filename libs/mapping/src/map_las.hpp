#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "traverse/geodesy/local_tangent_plane.hpp"
#include "traverse/mapping/map_folder.hpp"

#include "map_points.hpp"

namespace traverse::mapping {

struct LasSummary {
  std::string frame;  ///< of the coordinates, in words
  bool has_gps_time = false;
};

/// Points as LAS 1.4: intensity, time, the ring as user data (255: not known), the run, from 1, as
/// source. \param origin of the map frame if it is ENU. \throws files::OutputError
LasSummary write_las(const std::filesystem::path& file, const MapPoints& points,
                     const std::optional<geodesy::Geodetic>& origin, LasFrame frame);

}  // namespace traverse::mapping
