#include "traverse/pipeline/preset.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/files/input_error.hpp"

namespace traverse::pipeline {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> preset_names(const fs::path& share_folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(share_folder / "pipelines")) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

fs::path find_preset(const std::string& name, const fs::path& share_folder) {
  const fs::path shipped = share_folder / "pipelines" / (name + ".yaml");
  if (fs::is_regular_file(shipped)) return shipped;
  if (fs::is_regular_file(name)) return name;
  throw files::InputError(
      "--pipeline", files::Place::whole_file(),
      fmt::format("one of {} or a YAML file", fmt::join(preset_names(share_folder), ", ")),
      files::in_quotes(name));
}

}  // namespace

Preset load_preset(const PresetRequest& request, const fs::path& share_folder) {
  Preset preset;
  preset.file = find_preset(request.name, share_folder);
  preset.name = preset.file.stem().string();
  preset.as_shipped = config::Document::load(preset.file);
  preset.resolved = config::Document::load(preset.file);
  for (const fs::path& file : request.config_files) {
    preset.resolved.overlay(config::Document::load(file));
  }
  for (const std::string& assignment : request.assignments) preset.resolved.set(assignment);
  return preset;
}

std::vector<PresetSummary> list_presets(const fs::path& share_folder) {
  std::vector<PresetSummary> summaries;
  for (const std::string& name : preset_names(share_folder)) {
    const auto document = config::Document::load(share_folder / "pipelines" / (name + ".yaml"));
    summaries.push_back({name, document.scalar("description").value_or("")});
  }
  return summaries;
}

}  // namespace traverse::pipeline
