#include "plan/plan_commands.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/digest.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"

#include "plan/command_text.hpp"
#include "plan/container.hpp"
#include "plan/plan_error.hpp"
#include "plan/plan_parts.hpp"

namespace traverse::batch {

namespace {

namespace fs = std::filesystem;
using config::Range;

constexpr std::array<std::string_view, 3> kPoseFrames{"body", "lidar", "camera"};
/// Folders have no ending.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kConverted{
    {{"kitti", ""},
     {"pcd", ""},
     {"ply", ""},
     {"bag", ".bag"},
     {"mcap", ".mcap"},
     {"rawlog", ".rawlog"}}};

/// A program of the PATH, as the shell finds it.
std::optional<fs::path> program_named(const std::string& name) {
  const char* path = std::getenv("PATH");
  if (name.find('/') != std::string::npos || path == nullptr) return std::nullopt;
  for (const auto folder : files::split_cells(path, ':')) {
    const fs::path file = fs::path(folder) / name;
    if (::access(file.c_str(), X_OK) == 0 && fs::is_regular_file(file)) return file;
  }
  return std::nullopt;
}

/// Whether a word before the program sets a variable for it ("OMP_NUM_THREADS=1").
bool is_assignment(std::string_view word) {
  const std::size_t equals = word.find('=');
  return equals != std::string_view::npos && word.find('/') > equals;
}

/// What the result depends on beside the recording: the command, its program, and the files that
/// it names, by their digests.
std::string command_identity(const PlannedCommand& command, const fs::path& folder) {
  std::string text = "command " + command.text + "\n";
  std::string plain;
  for_each_placeholder(
      command.text, [&](std::string_view piece) { plain += piece; },
      [&](const std::string& name) { plain += name == "plan" ? folder.string() : " "; });
  if (command.container) text += "container " + command.container.digest + "\n";
  bool is_program = !command.container;  // else it is the image's
  for (const std::string_view word : files::split_words(plain)) {
    if (is_assignment(word)) continue;
    fs::path file = (folder / std::string(word)).lexically_normal();
    if (is_program) file = program_named(std::string(word)).value_or(file);
    is_program = !command.container &&
                 (word == "|" || word == "&&" || word == ";" || word == "exec" || word == "env");
    if (!fs::is_regular_file(file)) continue;
    text += fmt::format("file {} {}\n", word, files::sha256_of_file(file));
  }
  if (!command.config_file.empty()) {
    text += "config " + files::sha256_of_file(command.config_file) + "\n";
  }
  return text + fmt::format("trajectory {}\nposes {} {} {} {} {} {} {} {} {}\n", command.trajectory,
                            command.version, command.format, command.columns, command.topic,
                            command.frame, fmt::join(command.extrinsic, " "), command.time_offset,
                            command.max_gap_s, command.deskew);
}

std::vector<GridAxis> grid_of_command(const config::Document& entry) {
  std::vector<GridAxis> axes;
  for (const config::Leaf& leaf : entry.child("grid").leaves()) {
    if (!leaf.items || leaf.items->empty()) {
      throw plan_error(leaf.origin, "a list of values for '" + leaf.path + "'", leaf.text);
    }
    axes.push_back({leaf.path, *leaf.items, leaf.origin});
  }
  return axes;
}

}  // namespace

std::string_view ending_of_format(std::string_view format) {
  const auto found = std::find_if(kConverted.begin(), kConverted.end(),
                                  [&](const auto& entry) { return entry.first == format; });
  return found == kConverted.end() ? "?" : found->second;
}

config::Document with_recipe(config::Document entry, const fs::path& share_folder) {
  const fs::path folder = share_folder / "systems";
  const std::string name = entry.scalar("system").value_or("");
  const fs::path file = folder / (name + ".yaml");
  if (!fs::is_regular_file(file)) {
    std::vector<std::string> known;
    std::error_code failure;
    for (const auto& there : fs::directory_iterator(folder, failure)) {
      if (there.path().extension() == ".yaml") known.push_back(there.path().stem().string());
    }
    std::sort(known.begin(), known.end());
    throw plan_error(
        entry.origin(),
        fmt::format("a system that share/systems has a recipe of: {}", fmt::join(known, ", ")),
        files::in_quotes(name));
  }
  config::Document recipe = config::Document::load(file);
  recipe.overlay(entry);
  return recipe;
}

PlannedPipeline read_command(const config::Document& entry, const fs::path& folder) {
  PlannedPipeline pipeline;
  PlannedCommand& command = pipeline.command;
  pipeline.origin = entry.origin();
  std::array<std::string_view, dataset::kTrajectoryFormatNames.size()> formats;
  for (std::size_t i = 0; i < formats.size(); ++i) {
    formats[i] = dataset::kTrajectoryFormatNames[i].first;
  }
  std::string config;
  std::string system;
  std::string about;
  std::string image;
  static constexpr std::array<std::string_view, 3> kOthers{"set", "grid", "statements"};
  config::read(
      entry,
      [&](config::Binder& b) {
        b.text("system", system, "recipe of share/systems");
        b.text("about", about, "the program, for people");
        b.text("name", pipeline.name, "of the program, in tables");
        b.text("command", command.text, "how it is started, for /bin/sh");
        b.text("trajectory", command.trajectory, "what it writes: a path or a pattern");
        b.text("version", command.version, "of the program");
        b.text("container", image, "image in which it runs, of apptainer or podman");
        b.text("config", config, "file that {config} stands for");
        b.word("format", command.format, formats, "of the trajectory");
        b.text("columns", command.columns, "of a CSV trajectory");
        b.text("topic", command.topic, "of a bag");
        b.word("frame", command.frame, kPoseFrames, "what moves along the poses");
        b.numbers("extrinsic", command.extrinsic, "its pose in that frame");
        b.text("time_offset", command.time_offset, "seconds added to the stamps, or auto");
        b.number("max_gap_s", command.max_gap_s, Range::between(0, 3600),
                 "poses further apart are not interpolated between");
        b.flag("deskew", command.deskew, "undo the motion within a sweep");
      },
      kOthers);
  if (pipeline.name.empty()) throw plan_error(pipeline.origin, "a 'name' of the command", "none");
  if (command.trajectory.empty()) {
    throw plan_error(pipeline.origin, "a 'trajectory': what the command writes", "none");
  }
  if (!config.empty()) {
    command.config_file = (folder / config).lexically_normal();
    if (!fs::is_regular_file(command.config_file)) {
      throw plan_error(pipeline.origin, "a file that is there",
                       files::in_quotes(command.config_file.string()));
    }
  }
  const auto offset = files::parse_double(command.time_offset);
  if (!command.time_offset.empty() && command.time_offset != "auto" && !offset) {
    throw plan_error(pipeline.origin, "a time_offset in seconds, or auto",
                     files::in_quotes(command.time_offset));
  }
  for (const std::string& format : command.formats()) {
    if (ending_of_format(format) != "?") continue;
    throw plan_error(pipeline.origin, "{format:kitti}, pcd, ply, bag, mcap or rawlog",
                     files::in_quotes("{format:" + format + "}"));
  }
  if (!image.empty()) {
    command.container = find_container(image, folder, *entry.origin("container"));
  }
  pipeline.statements = assignments_under(entry, "statements");
  for (const config::Leaf& leaf : entry.child("set").leaves()) {
    pipeline.assignments.push_back(leaf.path + "=" + leaf.text);
  }
  pipeline.grid = grid_of_command(entry);
  command.identity = command_identity(command, folder);
  return pipeline;
}

void check_command(const PlannedPipeline& pipeline, const std::vector<std::string>& settings) {
  CommandPlaces places;
  places.settings = pipeline.assignments;
  places.settings.insert(places.settings.end(), settings.begin(), settings.end());
  for (const std::string& format : pipeline.command.formats()) places.converted[format] = "there";
  try {
    expanded(pipeline.command, places);
  } catch (const std::invalid_argument& error) {
    throw plan_error(pipeline.origin,
                     "{recording}, {format:NAME}, {out}, {threads}, {config}, {plan} or a key "
                     "under 'set' or 'grid'",
                     error.what());
  }
}

}  // namespace traverse::batch
