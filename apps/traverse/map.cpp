#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "traverse/config/document.hpp"
#include "traverse/config/settings.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/mapping/map_folder.hpp"
#include "traverse/mapping/merge_runs.hpp"
#include "traverse/pipeline/run_keyframes.hpp"

#include "commands.hpp"
#include "progress_bar.hpp"
#include "standard_streams.hpp"

namespace traverse::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* kMapExamples = R"(Examples:
  traverse map RUN -o MAP                        map.ply, map.simplemap, grid.png and grid.yaml
  traverse map RUN -o MAP --set voxel_m=0.2 --attributes
                                                 coarser; time, ring and keyframe of every point
  traverse map RUN -o MAP --las                  map.las too: UTM grid, GPS time, intensity, rings
  traverse map RUN -o MAP --las --set las_frame=local
                                                 its coordinates in the map frame
  traverse map RUN -o MAP --keep-moving --no-grid
                                                 all points, no occupancy grid
  traverse map other.simplemap -o MAP            from a simple map of another MRPT program
  traverse map MONDAY TUESDAY -o MAP             two runs of one place in the frame of the first

RUN is the folder of a run, or a .simplemap. Several runs are merged if they show the same places:
scans that look alike are registered, and a pose graph brings all keyframes together. Points that
rays of other keyframes pass through, passing cars above all, are left out. DIR must be new or empty,
or an earlier map and nothing else, which is replaced when the new one is complete. grid.yaml opens in ROS'
map servers, map.ply in CloudCompare and MeshLab. A run with GNSS gives a map in east, north and
up; origin.json says where on earth, and map.las is in the UTM zone of that origin with heights above
the ellipsoid. LAZ is not written; `las2las -i map.las -o map.laz` of LAStools compresses it.)";

struct MapSettings {
  mapping::MapOptions map;
  mapping::MergeOptions merge;
};

struct MapArguments {
  std::vector<std::string> runs;
  std::string destination;
  std::vector<std::string> assignments;
  bool attributes = false;
  bool las = false;
  bool keep_moving = false;
  bool no_grid = false;
};

void bind(config::Binder& b, MapSettings& settings) {
  bind(b, settings.map);
  b.group("merge", "how runs are brought together",
          [&](config::Binder& g) { bind(g, settings.merge); });
}

void print_settings() {
  MapSettings settings;
  for (const config::Setting& setting : config::list([&](auto& b) { bind(b, settings); })) {
    const std::string allowed = setting.allowed.empty() ? "" : " (" + setting.allowed + ")";
    fmt::print("{:<26}{:<8}{}{}\n", setting.path, config::to_text(setting.value), setting.meaning,
               allowed);
  }
}

MapSettings settings_from(const MapArguments& arguments) {
  MapSettings settings;
  mapping::MapOptions& options = settings.map;
  options.attributes = arguments.attributes;
  options.las = arguments.las;
  options.remove_moving = !arguments.keep_moving;
  options.with_grid = !arguments.no_grid;
  config::Document document;
  for (const std::string& assignment : arguments.assignments) document.set(assignment);
  print_notes(config::read(document, [&](config::Binder& b) { bind(b, settings); }));
  return settings;
}

/// A bar for each stage of the work.
class StageBars {
 public:
  void update(const std::string& stage, double share) {
    if (stage != stage_) {
      finish();
      bar_.emplace(stage, 0, "steps");
      stage_ = stage;
      steps_ = 0;
    }
    bar_->update(++steps_, share);
  }
  void finish() {
    if (bar_) bar_->finish();
    bar_.reset();
  }

 private:
  std::optional<ProgressBar> bar_;
  std::string stage_;
  std::size_t steps_ = 0;
};

/// The keyframes of all runs, in the map frame of the first one.
std::vector<mapping::MapKeyframe> keyframes_of(const std::vector<std::string>& runs,
                                               const mapping::MergeOptions& options,
                                               StageBars& bars) {
  std::vector<std::vector<mapping::MapKeyframe>> by_run;
  for (const std::string& run : runs) {
    auto& keyframes = by_run.emplace_back(pipeline::read_map_keyframes(run));
    for (auto& keyframe : keyframes) keyframe.run = static_cast<std::uint16_t>(by_run.size() - 1);
  }
  if (by_run.size() == 1) return std::move(by_run.front());
  mapping::MergedRuns merged;
  try {
    merged = mapping::merge_runs(
        std::move(by_run), options,
        [&](const std::string& stage, double share) { bars.update(stage, share); });
  } catch (const mapping::NoOverlap& error) {
    bars.finish();
    throw std::runtime_error(fmt::format(
        "{} shows no place for sure that the other runs show: no common map", runs[error.run()]));
  }
  bars.finish();
  std::vector<mapping::MapKeyframe> all;
  for (auto& keyframes : merged.runs) {
    std::move(keyframes.begin(), keyframes.end(), std::back_inserter(all));
  }
  const auto rejected = std::count_if(merged.links.begin(), merged.links.end(),
                                      [](const auto& link) { return link.weight < 0.25; });
  fmt::print("{} runs brought together by {} links, {} of them rejected\n", runs.size(),
             merged.links.size(), rejected);
  return all;
}

/// An earlier map is replaced as a whole, and so would be a simple map in it that this one is made
/// of.
void refuse_to_replace_an_input(const MapArguments& arguments) {
  for (const std::string& run : arguments.runs) {
    std::error_code failure;
    const fs::path input = fs::absolute(run);
    const fs::path folder = fs::is_directory(input, failure) ? input : input.parent_path();
    if (fs::equivalent(folder, arguments.destination, failure)) {
      throw files::OutputError(arguments.destination,
                               fmt::format("{} is read from it. Choose another folder", run));
    }
  }
}

files::AtomicFolder new_folder(const mapping::MapFolder& folder) {
  std::vector<std::string> earlier = mapping::files_of_earlier_map(folder);
  const fs::path place = fs::absolute(folder.path).lexically_normal();
  files::make_writable_folder(place.has_filename() ? place.parent_path()
                                                   : place.parent_path().parent_path());
  return files::AtomicFolder(folder.path, std::move(earlier));
}

void make_map(const MapArguments& arguments) {
  const MapSettings settings = settings_from(arguments);
  const mapping::MapOptions& options = settings.map;
  const mapping::MapFolder folder{arguments.destination};
  refuse_to_replace_an_input(arguments);
  files::AtomicFolder output = new_folder(folder);
  StageBars bars;
  auto keyframes = keyframes_of(arguments.runs, settings.merge, bars);
  const auto summary = mapping::write_map(
      {output.temporary_path()}, std::move(keyframes),
      pipeline::read_origin({arguments.runs.front()}), options,
      [&](const std::string& stage, double share) { bars.update(stage, share); });
  output.commit();
  bars.finish();
  fmt::print("{} keyframes, {} points in {}\n", summary.keyframes, summary.points,
             folder.points().string());
  if (options.las) {
    fmt::print("{}: {}, {}\n", folder.las().string(), summary.las_frame,
               summary.las_has_gps_time
                   ? "adjusted standard GPS time"
                   : "times of the recording's own clock, for its stamps are no dates");
  }
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
  map->add_option("RUN", arguments->runs, "run folders, or simple maps of MRPT, of one place")
      ->required()
      ->check(CLI::ExistingPath);
  map->add_option("-o,--output", arguments->destination,
                  "folder of the map: new, or an earlier map")
      ->required()
      ->type_name("DIR");
  map->add_option("--set", arguments->assignments, "a setting, as in --set grid.cell_m=0.05")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  map->add_flag_callback(
      "--settings",
      [] {
        print_settings();
        throw CLI::Success();
      },
      "list what --set takes, with its value and its meaning");
  map->add_flag("--attributes", arguments->attributes,
                "time, ring and keyframe of each point beside its intensity");
  map->add_flag("--las", arguments->las, "the points as LAS 1.4 too: map.las");
  map->add_flag("--keep-moving", arguments->keep_moving, "leave moving objects in");
  map->add_flag("--no-grid", arguments->no_grid, "no occupancy grid");
  map->footer(kMapExamples);
  map->callback([arguments] { make_map(*arguments); });
}

}  // namespace traverse::app
