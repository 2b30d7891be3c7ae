#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "traverse/geodesy/local_tangent_plane.hpp"
#include "traverse/mapping/map_folder.hpp"

namespace traverse::mapping {

struct LasExport {
  std::uint64_t points = 0;
  std::uint64_t left_out = 0;  ///< whose coordinates are no numbers
  std::string frame;           ///< of the coordinates, in words
  bool has_time = false;
  bool has_gps_time = false;
};

/// Writes the points of a binary PLY file, whose x, y and z are metres, as LAS 1.4; where they have
/// them, their `intensity` (0 .. 1, or 0 .. 255 in whole numbers), `time` (seconds) and `ring`.
/// Block by block: memory does not grow with the file.
/// \param origin of the file's frame if it is east, north, up; then the coordinates may be a grid's
/// \throws files::InputError, files::OutputError
LasExport export_las(const std::filesystem::path& ply,
                     const std::optional<geodesy::Geodetic>& origin, LasFrame frame,
                     const std::filesystem::path& las,
                     const std::function<void(double share)>& progress = {});

}  // namespace traverse::mapping
