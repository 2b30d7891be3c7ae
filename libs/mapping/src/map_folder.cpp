#include "traverse/mapping/map_folder.hpp"

#include "traverse/mapping/keyframe_map.hpp"
#include "traverse/mapping/map_origin.hpp"

#include "map_points.hpp"

namespace traverse::mapping {

namespace {

KeyframeMap simple_map_of(const std::vector<MapKeyframe>& keyframes, const MapFolder& folder) {
  KeyframeMapOptions as_they_are;
  as_they_are.voxel_m = 0.01;  // thinned when they were made
  KeyframeMap map(as_they_are, folder.path);
  for (const MapKeyframe& keyframe : keyframes) map.add(keyframe);
  return map;
}

}  // namespace

void bind(config::Binder& b, MapOptions& o) {
  b.number("voxel_m", o.voxel_m, config::Range::between(0.005, 10),
           "of the points in a cube of this edge one is kept");
  b.flag("attributes", o.attributes, "time, ring and keyframe of each point beside its intensity");
  b.flag("remove_moving", o.remove_moving, "leave out what rays of other keyframes pass through");
  b.group("free_space", "what counts as moving", [&](config::Binder& g) { bind(g, o.free_space); });
  b.flag("with_grid", o.with_grid, "an occupancy grid beside the points");
  b.group("grid", "of the occupancy grid", [&](config::Binder& g) { bind(g, o.grid); });
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
  return summary;
}

}  // namespace traverse::mapping
