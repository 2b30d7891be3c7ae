#include "open_request.hpp"

#include <CLI/CLI.hpp>

#include "installed_files.hpp"

namespace traverse::app {

void add_options(CLI::App& app, OpenRequest& request) {
  app.add_option("FILE|RUN", request.file_or_run,
                 "MRPT rawlog, any other recording that `traverse run` takes, or a run folder");
  app.add_option("--pipeline", request.preset.name, "preset, or a YAML file in its form")
      ->capture_default_str();
  app.add_option("--config", request.preset.config_files, "YAML file laid over the preset")
      ->option_text("FILE")
      ->check(CLI::ExistingFile)
      ->allow_extra_args(false);
  app.add_option("--set", request.preset.assignments, "one setting, stronger than any file")
      ->option_text("KEY=VALUE ...")
      ->allow_extra_args(false);
  app.add_option("--at", request.at,
                 "begin at a frame (120), a time from the start (12.5s, 1:02.5) or a stamp");
  app.add_flag("--play", request.play, "begin to play at once");
  app.add_option("--threads", request.threads, "of the estimator; the result does not depend on it")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app.add_option("--recording-config", request.recording_config,
                 "YAML file of statements about the recording, over its own traverse.yaml")
      ->option_text("FILE");
  app.add_option("--recording", request.statements,
                 "one statement about the recording: reference.file=gt.tum, ...")
      ->option_text("KEY=VALUE ...")
      ->allow_extra_args(false);
  app.add_option("--moved-to", request.moved_to, "where the recording of a run folder is now");
  app.add_option("-o,--output", request.output_folder, "folder of screenshots and saved maps")
      ->capture_default_str();
  app.add_option("--script", request.script, "file of commands (--help-script) to work through")
      ->check(CLI::ExistingFile);
  app.add_flag("--headless", request.headless,
               "nobody watches: end with the script, report faults by the exit status; a display "
               "is needed all the same, as xvfb-run gives one");
  app.add_option("--width", request.width, "of the window, pixels")
      ->check(CLI::Range(800, 8000))
      ->capture_default_str();
  app.add_option("--height", request.height, "of the window, pixels")
      ->check(CLI::Range(500, 8000))
      ->capture_default_str();
  app.add_flag("!--no-index-cache", request.keep_index,
               "do not keep the index of a rawlog in the cache folder");
}

replay::Recording open(const OpenRequest& request) {
  dataset::OpenOptions options;
  if (!request.recording_config.empty()) options.statements_file = request.recording_config;
  options.statements = request.statements;
  options.share_folder = find_installed_files().share;
  return replay::Recording::open(request.file_or_run, options, request.moved_to);
}

}  // namespace traverse::app
