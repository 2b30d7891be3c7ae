#include "traverse/mapping/map_folder.hpp"

#include <array>
#include <fstream>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/mapping/keyframe_map.hpp"
#include "traverse/mapping/map_origin.hpp"

#include "map_las.hpp"
#include "map_points.hpp"

namespace traverse::mapping {

namespace {

namespace fs = std::filesystem;

constexpr const char* kWrittenBy = "traverse map";
constexpr std::array kLasFrames{std::pair<std::string_view, LasFrame>{"grid", LasFrame::kGrid},
                                std::pair<std::string_view, LasFrame>{"local", LasFrame::kLocal}};

KeyframeMap simple_map_of(const std::vector<MapKeyframe>& keyframes, const MapFolder& folder) {
  KeyframeMapOptions as_they_are;
  as_they_are.voxel_m = 0.01;  // thinned when they were made
  KeyframeMap map(as_they_are, folder.path);
  for (const MapKeyframe& keyframe : keyframes) map.add(keyframe);
  return map;
}

/// Every file that is in the folder of a new map.
std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

void write_record(const MapFolder& folder, const MapSummary& summary) {
  const nlohmann::ordered_json json{{"written_by", kWrittenBy},
                                    {"keyframes", summary.keyframes},
                                    {"points", summary.points},
                                    {"removed_points", summary.removed_points},
                                    {"files", names_in(folder.path)}};
  files::write_text(folder.record(), json.dump(1) + "\n");
}

/// What the record lists; nothing if it is not one.
std::set<std::string> recorded_names(const fs::path& record) {
  std::ifstream stream(record);
  const auto json = nlohmann::json::parse(stream, nullptr, /*allow_exceptions=*/false);
  std::set<std::string> names;
  if (!json.is_object() || !json.contains("files") || !json["files"].is_array() ||
      json.value("written_by", nlohmann::json()) != kWrittenBy) {
    return names;
  }
  names.insert(record.filename().string());
  for (const auto& name : json["files"]) {
    if (name.is_string()) names.insert(name.get<std::string>());
  }
  return names;
}

}  // namespace

std::vector<std::string> files_of_earlier_map(const MapFolder& folder) {
  std::error_code failure;
  if (!fs::exists(folder.path, failure)) return {};
  if (!fs::is_directory(folder.path, failure)) {
    throw files::OutputError(folder.path, "it is not a folder");
  }
  const std::set<std::string> recorded = recorded_names(folder.record());
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder.path)) {
    const std::string name = entry.path().filename().string();
    if (!recorded.contains(name)) {
      throw files::OutputError(
          folder.path, recorded.empty()
                           ? "it is no map that this program wrote (it has no map.json), and " +
                                 files::in_quotes(name) + " is in it. Choose another folder"
                           : files::in_quotes(name) +
                                 " is in it, which is no part of the map there. Move it away, or "
                                 "choose another folder");
    }
    names.push_back(name);
  }
  return names;
}

void bind(config::Binder& b, MapOptions& o) {
  b.number("voxel_m", o.voxel_m, config::Range::between(0.005, 10),
           "voxel size: one point per voxel is kept");
  b.flag("attributes", o.attributes, "time, ring and keyframe of each point beside its intensity");
  b.flag("las", o.las, "the points as LAS 1.4 beside map.ply");
  b.choice("las_frame", o.las_frame, kLasFrames,
           "coordinates of the LAS file: UTM grid, where the map has a place on earth, or the map "
           "frame");
  b.flag("remove_moving", o.remove_moving,
         "leave out points that rays of other keyframes pass through");
  b.group("free_space", "detection of moving points",
          [&](config::Binder& g) { bind(g, o.free_space); });
  b.flag("with_grid", o.with_grid, "an occupancy grid beside the points");
  b.group("grid", "settings of the occupancy grid", [&](config::Binder& g) { bind(g, o.grid); });
}

MapSummary write_map(const MapFolder& folder, std::vector<MapKeyframe> keyframes,
                     const std::optional<geodesy::Geodetic>& origin, const MapOptions& options,
                     const MapProgress& progress) {
  MapSummary summary;
  summary.keyframes = keyframes.size();
  const auto tell = [&](const char* stage, double share) {
    if (progress) progress(stage, share);
  };
  if (options.remove_moving) {
    const FreeSpace free_space(keyframes, options.free_space,
                               [&](double share) { tell("moving objects", share); });
    summary.removed_points = remove_free_points(free_space, keyframes);
  }
  tell("points", 0);
  const MapPoints points = map_points(keyframes, options.voxel_m);
  summary.points = points.size();
  write_ply(folder.points(), points, options.attributes);
  if (options.las) {
    const LasSummary las = write_las(folder.las(), points, origin, options.las_frame);
    summary.las_frame = las.frame;
    summary.las_has_gps_time = las.has_gps_time;
  }
  tell("points", 0.5);
  simple_map_of(keyframes, folder).write(folder.simple_map());
  if (origin) write_map_origin(folder.origin(), *origin);
  tell("points", 1);
  if (options.with_grid) {
    tell("occupancy grid", 0);
    const OccupancyGrid grid(keyframes, options.grid);
    grid.write(folder.grid_image(), folder.grid());
    summary.grid_columns = grid.columns();
    summary.grid_rows = grid.rows();
    tell("occupancy grid", 1);
  }
  write_record(folder, summary);
  return summary;
}

}  // namespace traverse::mapping
