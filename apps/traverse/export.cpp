#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/mapping/las_export.hpp"
#include "traverse/mapping/map_origin.hpp"

#include "commands.hpp"
#include "progress_bar.hpp"

namespace traverse::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* kExportExamples = R"(Examples:
  traverse export RUN map.las                    the points of a run, in the UTM zone of its origin
  traverse export MAP map.las --frame local      of a map folder, in its own frame
  traverse export cloud.ply cloud.las --origin 48.1372,11.5756,560.2
                                                 a cloud in east, north, up at that place

A RUN or MAP gives its map.ply; origin.json beside a cloud says where on earth its frame is, as --origin
does (degrees north and east, metres above the ellipsoid). Clouds are binary PLY with x, y and z in
metres; intensity, time and ring are taken along where they are. `traverse map --las` makes the map
anew, with the time and ring of each point. Memory does not grow with the cloud.)";

struct ExportArguments {
  std::string source;
  std::string destination;
  std::vector<double> origin;
  std::string frame = "grid";
};

fs::path cloud_of(const fs::path& source) {
  if (!fs::is_directory(source)) return source;
  fs::path cloud = source / "map.ply";
  if (!fs::exists(cloud)) {
    throw files::InputError(cloud, files::Place::whole_file(),
                            "the points of a run with a lidar or of a map (traverse map)",
                            "no such file");
  }
  return cloud;
}

std::optional<geodesy::Geodetic> origin_of(const ExportArguments& arguments,
                                           const fs::path& cloud) {
  if (!arguments.origin.empty()) {
    return geodesy::Geodetic{arguments.origin[0], arguments.origin[1], arguments.origin[2]};
  }
  const fs::path beside = cloud.parent_path() / "origin.json";
  if (fs::exists(beside)) return mapping::read_map_origin(beside);
  return std::nullopt;
}

void export_cloud(const ExportArguments& arguments) {
  if (fs::path(arguments.destination).extension() != ".las") {
    throw files::OutputError(arguments.destination,
                             "its name must end in .las, the form that is written");
  }
  const fs::path cloud = cloud_of(arguments.source);
  ProgressBar bar("points", 0, "blocks");
  std::size_t blocks = 0;
  const auto result = mapping::export_las(
      cloud, origin_of(arguments, cloud),
      arguments.frame == "local" ? mapping::LasFrame::kLocal : mapping::LasFrame::kGrid,
      arguments.destination, [&](double share) { bar.update(++blocks, share); });
  bar.finish();
  const char* times = result.has_gps_time ? "adjusted standard GPS time"
                      : result.has_time   ? "times of a clock of their own, which are no dates"
                                          : "no times";
  fmt::print("{} points in {}: {}, {}\n", result.points, arguments.destination, result.frame,
             times);
  if (result.left_out > 0) {
    fmt::print("{} points left out: their coordinates are no numbers\n", result.left_out);
  }
}

}  // namespace

void add_export(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command =
      app.add_subcommand("export", "the points of a run, a map or a PLY file as LAS 1.4");
  command
      ->add_option("SOURCE", arguments->source, "folder of a run or of a map, or a binary PLY file")
      ->required()
      ->check(CLI::ExistingPath);
  command->add_option("FILE", arguments->destination, "what is written: a name that ends in .las")
      ->required();
  command
      ->add_option("--origin", arguments->origin,
                   "where on earth the cloud's frame is, if it is east, north, up")
      ->delimiter(',')
      ->expected(3)
      ->type_name("LAT,LON,HEIGHT");
  command
      ->add_option("--frame", arguments->frame,
                   "coordinates: the UTM grid of the origin's zone, or the cloud's own")
      ->check(CLI::IsMember({"grid", "local"}))
      ->capture_default_str();
  command->footer(kExportExamples);
  command->callback([arguments] { export_cloud(*arguments); });
}

}  // namespace traverse::app
