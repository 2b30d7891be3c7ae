#include "recording_options.hpp"

#include <CLI/CLI.hpp>

#include "installed_files.hpp"

namespace traverse::app {

dataset::OpenOptions RecordingOptions::open_options() const {
  dataset::OpenOptions options;
  if (!config.empty()) options.statements_file = config;
  options.statements = statements;
  options.share_folder = find_installed_files().share;
  return options;
}

std::unique_ptr<dataset::Source> RecordingOptions::open() const {
  return dataset::open_recording(recording, open_options());
}

std::vector<std::string> RecordingOptions::lasting_statements() const {
  return dataset::lasting_statements(recording, open_options());
}

void add_recording_options(CLI::App& command, RecordingOptions& options, const std::string& name) {
  command
      .add_option(name, options.recording,
                  "a file or folder; `traverse info --formats` lists the kinds that are read")
      ->required();
  command
      .add_option("--recording-config", options.config,
                  "YAML file of statements about the recording, over its own traverse.yaml")
      ->option_text("FILE");
  command
      .add_option("--recording", options.statements,
                  "one statement about the recording, over all files; may be repeated: "
                  "motion_compensated=true, sensor=hdl64e_kitti, lidar.sweep_s=0.1, "
                  "reference.file=gt.tum")
      ->option_text("KEY=VALUE ...")
      ->allow_extra_args(false);
}

}  // namespace traverse::app
