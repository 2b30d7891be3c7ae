#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "traverse/exports/las_writer.hpp"
#include "traverse/geodesy/local_tangent_plane.hpp"
#include "traverse/geodesy/map_grid.hpp"
#include "traverse/mapping/map_folder.hpp"

#include "map_points.hpp"

namespace traverse::mapping {

/// What the coordinates of a map become in a LAS file.
struct LasCoordinates {
  LasCoordinates(const std::optional<geodesy::Geodetic>& origin, LasFrame frame);
  Eigen::Vector3d operator()(const Eigen::Vector3d& p_map);

  std::optional<geodesy::MapGrid> grid;
  std::string in_words;
  exports::LasDescription description;  ///< coordinate system, offset and day of writing
};

/// Of an intensity from 0 to 1.
std::uint16_t las_intensity(float share);
inline constexpr std::uint8_t kUnknownLasRing = 255;

struct LasSummary {
  std::string frame;  ///< of the coordinates, in words
  bool has_gps_time = false;
};

/// Points as LAS 1.4: intensity, time, the ring as user data, the run, from 1, as source.
/// \param origin of the map frame if it is ENU. \throws files::OutputError
LasSummary write_las(const std::filesystem::path& file, const MapPoints& points,
                     const std::optional<geodesy::Geodetic>& origin, LasFrame frame);

}  // namespace traverse::mapping
