#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "traverse/config/document.hpp"
#include "traverse/config/settings.hpp"

namespace traverse::pipeline {

/// What the user asks of a preset: files and single keys on top of it.
struct PresetRequest {
  std::string name = "traverse";  ///< of share/pipelines/NAME.yaml, or the path of a YAML file
  std::vector<std::filesystem::path> config_files;  ///< laid over the preset in order
  std::vector<std::string> assignments;             ///< "solver.huber_m=0.2", the strongest
};

/// A preset found, and the configuration that results.
struct Preset {
  std::string name;
  std::filesystem::path file;
  config::Document as_shipped;
  config::Document resolved;
};

/// \throws files::InputError if there is no such preset (naming those there are) or a file or an
/// assignment is wrong.
Preset load_preset(const PresetRequest& request, const std::filesystem::path& share_folder);

/// Name and description of each preset in share/pipelines, sorted by name.
struct PresetSummary {
  std::string name;
  std::string description;
};
std::vector<PresetSummary> list_presets(const std::filesystem::path& share_folder);

}  // namespace traverse::pipeline
