#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "traverse/config/binder.hpp"
#include "traverse/geodesy/local_tangent_plane.hpp"
#include "traverse/mapping/free_space.hpp"
#include "traverse/mapping/map_keyframe.hpp"
#include "traverse/mapping/occupancy_grid.hpp"

namespace traverse::mapping {

/// The places of a map's files.
struct MapFolder {
  std::filesystem::path path;

  std::filesystem::path points() const { return path / "map.ply"; }
  std::filesystem::path las() const { return path / "map.las"; }  ///< where it was asked for
  std::filesystem::path simple_map() const { return path / "map.simplemap"; }
  std::filesystem::path grid_image() const { return path / "grid.png"; }
  std::filesystem::path grid() const { return path / "grid.yaml"; }
  /// Only of a map whose frame is ENU.
  std::filesystem::path origin() const { return path / "origin.json"; }
  /// What the map is made of, and the names of its files: by it an earlier map is known.
  std::filesystem::path record() const { return path / "map.json"; }
};

/// The names of all files of a map that is in the folder already, to be replaced by another; none
/// if the folder is empty or not there.
/// \throws files::OutputError naming what is in the folder that no map of this program put there.
std::vector<std::string> files_of_earlier_map(const MapFolder& folder);

/// What the coordinates of a LAS file are.
enum class LasFrame : std::uint8_t {
  kGrid,   ///< the UTM grid of the origin's zone; the map frame of a map without an origin
  kLocal,  ///< the map frame: east, north, up at the origin, where there is one
};

struct MapOptions {
  double voxel_m = 0.1;     ///< of the points of map.ply
  bool attributes = false;  ///< time, ring and keyframe beside them
  bool las = false;         ///< the points as LAS too
  LasFrame las_frame = LasFrame::kGrid;
  bool remove_moving = true;  ///< points in free space are left out everywhere
  bool with_grid = true;
  FreeSpaceOptions free_space;
  OccupancyOptions grid;
};
void bind(config::Binder& binder, MapOptions& options);

/// What a map has become.
struct MapSummary {
  std::size_t keyframes = 0;
  std::size_t removed_points = 0;  ///< of keyframes, as in free space
  std::size_t points = 0;          ///< of map.ply
  std::string las_frame;           ///< its coordinates in words; empty without LAS
  bool las_has_gps_time = false;   ///< else its times are of the recording's own clock
  std::size_t grid_columns = 0;    ///< 0 without a grid
  std::size_t grid_rows = 0;
};

/// Told what is done now, and how much of it, of 1.
using MapProgress = std::function<void(const std::string& stage, double share)>;

/// Makes every file of a map from its keyframes and writes it to a folder, which must be there.
/// \param origin of the map frame if it is ENU
/// \throws files::OutputError; std::invalid_argument as OccupancyGrid does
MapSummary write_map(const MapFolder& folder, std::vector<MapKeyframe> keyframes,
                     const std::optional<geodesy::Geodetic>& origin, const MapOptions& options,
                     const MapProgress& progress = {});

}  // namespace traverse::mapping
