#include "plan/plan_pipelines.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/pipeline/registry.hpp"

#include "plan/plan_commands.hpp"
#include "plan/plan_error.hpp"
#include "plan/plan_parts.hpp"

namespace traverse::batch {

namespace {

namespace fs = std::filesystem;
using config::Document;
using config::Leaf;
using config::Origin;
using files::InputError;

std::vector<GridAxis> read_grid(const Document& mapping) {
  std::vector<GridAxis> axes;
  for (const Leaf& leaf : mapping.leaves()) {
    if (!leaf.items || leaf.items->empty()) {
      throw plan_error(leaf.origin, "a list of values for '" + leaf.path + "'", leaf.text);
    }
    std::set<std::string> seen;
    for (const std::string& value : *leaf.items) {
      if (!seen.insert(value).second) {
        throw plan_error(leaf.origin, "each value once", files::in_quotes(value) + " again");
      }
    }
    axes.push_back({leaf.path, *leaf.items, leaf.origin});
  }
  return axes;
}

/// A preset's name, or a YAML file beside the plan.
std::string find_preset(const std::string& preset, const fs::path& folder) {
  const fs::path file = (folder / preset).lexically_normal();
  return fs::is_regular_file(file) ? file.string() : preset;
}

std::vector<fs::path> read_config_files(const Document& entry, const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const Document& item : entry.items("config", "file")) {
    fs::path file = (folder / item.scalar("file").value_or("")).lexically_normal();
    if (!fs::is_regular_file(file)) {
      throw plan_error(item.origin(), "a file that is there", files::in_quotes(file.string()));
    }
    paths.push_back(std::move(file));
  }
  return paths;
}

PlannedPipeline read_entry(const Document& document, const std::vector<GridAxis>& common_grid,
                           const fs::path& folder) {
  PlannedPipeline pipeline;
  pipeline.origin = document.origin();
  static constexpr std::array<std::string_view, 4> kOthers{"config", "set", "grid", "statements"};
  config::read(
      document,
      [&](config::Binder& b) {
        b.text("preset", pipeline.preset, "a name of `traverse pipelines`, or a YAML file");
        b.text("name", pipeline.name, "in tables");
      },
      kOthers);
  if (pipeline.preset.empty()) throw plan_error(pipeline.origin, "a 'preset'", "none");
  if (pipeline.name.empty()) pipeline.name = fs::path(pipeline.preset).stem().string();
  pipeline.preset = find_preset(pipeline.preset, folder);
  pipeline.config_files = read_config_files(document, folder);
  pipeline.statements = assignments_under(document, "statements");

  std::map<std::string, Origin> varied;
  pipeline.grid = common_grid;
  for (GridAxis& axis : read_grid(document.child("grid"))) pipeline.grid.push_back(std::move(axis));
  for (const GridAxis& axis : pipeline.grid) {
    if (!varied.emplace(axis.key, axis.origin).second) {
      throw plan_error(axis.origin, "each key of the grid once",
                       files::in_quotes(axis.key) + " again");
    }
  }
  for (const Leaf& leaf : document.child("set").leaves()) {
    if (varied.contains(leaf.path)) {
      throw plan_error(leaf.origin, "a key that the grid does not vary",
                       files::in_quotes(leaf.path));
    }
    pipeline.assignments.push_back(leaf.path + "=" + leaf.text);
  }
  return pipeline;
}

/// Resolves the pipeline with each single value of its grid, so that a wrong one is told with its
/// own line; then the axes hold for every point, because settings do not depend on each other.
/// \param notes gets those on settings that were given by former names
void check_settings(const PlannedPipeline& pipeline, const fs::path& share_folder,
                    std::vector<std::string>& notes) {
  const auto check = [&](const std::vector<std::string>& more, const Origin& origin) {
    pipeline::PresetRequest request{pipeline.preset, pipeline.config_files, pipeline.assignments};
    request.assignments.insert(request.assignments.end(), more.begin(), more.end());
    try {
      for (std::string& note :
           pipeline::settings_notes(pipeline::load_preset(request, share_folder))) {
        if (std::find(notes.begin(), notes.end(), note) == notes.end())
          notes.push_back(std::move(note));
      }
    } catch (const InputError& error) {
      throw plan_error(origin, "a preset and settings that it takes", error.what());
    }
  };
  check({}, pipeline.origin);
  for (const GridAxis& axis : pipeline.grid) {
    for (const std::string& value : axis.values) check({axis.key + "=" + value}, axis.origin);
  }
}

}  // namespace

std::vector<PlannedPipeline> read_pipelines(const Document& plan, const fs::path& folder,
                                            const fs::path& share_folder,
                                            std::vector<std::string>& notes) {
  const std::vector<GridAxis> common_grid = read_grid(plan.child("grid"));
  std::vector<PlannedPipeline> pipelines;
  std::map<std::string, Origin> names;
  for (Document& entry : plan.items("pipelines", "preset")) {
    const Document item =
        entry.has("system") ? with_recipe(std::move(entry), share_folder) : std::move(entry);
    const bool is_command = item.has("command");
    PlannedPipeline pipeline =
        is_command ? read_command(item, folder) : read_entry(item, common_grid, folder);
    const auto [other, is_new] = names.emplace(pipeline.name, pipeline.origin);
    if (!is_new) {
      throw plan_error(pipeline.origin, "names that are there once (give it a 'name')",
                       fmt::format("{} again (first: line {})", files::in_quotes(pipeline.name),
                                   other->second.line));
    }
    if (is_command) {
      for (const auto& point : grid_points(pipeline.grid)) check_command(pipeline, point);
    } else {
      check_settings(pipeline, share_folder, notes);
    }
    pipelines.push_back(std::move(pipeline));
  }
  if (pipelines.empty()) {
    throw plan_error(plan.origin("pipelines").value_or(plan.origin()), "at least one pipeline",
                     "none");
  }
  return pipelines;
}

}  // namespace traverse::batch
