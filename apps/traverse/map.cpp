#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "traverse/config/document.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/mapping/map_folder.hpp"
#include "traverse/mapping/map_origin.hpp"
#include "traverse/pipeline/run_folder.hpp"

#include "commands.hpp"
#include "progress_bar.hpp"

namespace traverse::app {

namespace {

namespace fs = std::filesystem;

constexpr const char* kExamples = R"(Examples:
  traverse map RUN -o MAP                        map.ply, map.simplemap, grid.png and grid.yaml
  traverse map RUN -o MAP --set voxel_m=0.2 --attributes
                                                 coarser; time and keyframe of every point
  traverse map RUN -o MAP --keep-moving --no-grid
                                                 all points, no occupancy grid
  traverse map other.simplemap -o MAP            from a simple map of another MRPT program

RUN is the folder of a run, or a .simplemap. Points that rays of other keyframes pass through,
passing cars above all, are left out. grid.yaml opens in ROS' map servers, map.ply in CloudCompare
and MeshLab. A run with GNSS gives a map in east, north and up; origin.json says where on earth.)";

struct MapArguments {
  std::string run;
  std::string destination;
  std::vector<std::string> assignments;
  bool attributes = false;
  bool keep_moving = false;
  bool no_grid = false;
};

fs::path simple_map_of(const fs::path& run) {
  return fs::is_directory(run) ? pipeline::RunFolder{run}.simple_map() : run;
}

std::optional<geodesy::Geodetic> origin_of(const fs::path& run) {
  const fs::path file = pipeline::RunFolder{run}.origin();
  if (!fs::exists(file)) return std::nullopt;
  return mapping::read_map_origin(file);
}

mapping::MapOptions options_from(const MapArguments& arguments) {
  mapping::MapOptions options;
  options.attributes = arguments.attributes;
  options.remove_moving = !arguments.keep_moving;
  options.with_grid = !arguments.no_grid;
  config::Document document;
  for (const std::string& assignment : arguments.assignments) document.set(assignment);
  config::read(document, [&](config::Binder& b) { bind(b, options); });
  return options;
}

void make_map(const MapArguments& arguments) {
  const mapping::MapOptions options = options_from(arguments);
  files::make_writable_folder(arguments.destination);
  const mapping::MapFolder folder{arguments.destination};
  auto keyframes = mapping::read_simple_map(simple_map_of(arguments.run));
  std::optional<ProgressBar> bar;
  std::string stage;
  const auto summary = mapping::write_map(folder, std::move(keyframes), origin_of(arguments.run),
                                          options, [&](const std::string& name, double share) {
                                            if (name != stage) {
                                              if (bar) bar->finish();
                                              bar.emplace(name, 100, "%");
                                              stage = name;
                                            }
                                            bar->update(static_cast<std::size_t>(100 * share));
                                          });
  if (bar) bar->finish();
  fmt::print("{} keyframes, {} points in {}\n", summary.keyframes, summary.points,
             folder.points().string());
  if (options.remove_moving) {
    fmt::print("{} points of moving objects left out\n", summary.removed_points);
  }
  if (options.with_grid) {
    fmt::print("grid of {} by {} cells of {} m in {}\n", summary.grid_columns, summary.grid_rows,
               options.grid.cell_m, folder.grid().string());
  }
}

}  // namespace

void add_map(CLI::App& app) {
  auto arguments = std::make_shared<MapArguments>();
  CLI::App* map = app.add_subcommand(
      "map", "points without moving objects, and an occupancy grid, from the keyframes of a run");
  map->add_option("RUN", arguments->run, "run folder, or a simple map of MRPT")
      ->required()
      ->check(CLI::ExistingPath);
  map->add_option("-o,--output", arguments->destination, "folder of the map; made if not there")
      ->required()
      ->type_name("DIR");
  map->add_option("--set", arguments->assignments, "a setting, as in --set grid.cell_m=0.05")
      ->type_name("KEY=VALUE");
  map->add_flag("--attributes", arguments->attributes,
                "time and keyframe of each point beside its intensity");
  map->add_flag("--keep-moving", arguments->keep_moving, "leave moving objects in");
  map->add_flag("--no-grid", arguments->no_grid, "no occupancy grid");
  map->footer(kExamples);
  map->callback([arguments] { make_map(*arguments); });
}

}  // namespace traverse::app
