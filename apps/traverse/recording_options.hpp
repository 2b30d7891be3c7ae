#pragma once

#include <memory>
#include <string>
#include <vector>

#include "traverse/dataset/open_recording.hpp"

namespace CLI {
class App;
}

namespace traverse::app {

/// The arguments of every command that opens a recording: the recording itself,
/// --recording-config FILE and --recording KEY=VALUE.
struct RecordingOptions {
  std::string recording;  ///< path
  std::string config;     ///< path; empty if not given
  std::vector<std::string> statements;

  /// \throws std::runtime_error if the program's own files are not found.
  dataset::OpenOptions open_options() const;

  /// Opens the recording. \throws files::InputError
  std::unique_ptr<dataset::Source> open() const;

  /// What is stated, to hold from any working directory. \throws files::InputError
  std::vector<std::string> lasting_statements() const;
};

/// Declares them; `options` must outlive the parsing. `name` is what the help calls the recording.
void add_recording_options(CLI::App& command, RecordingOptions& options,
                           const std::string& name = "RECORDING");

}  // namespace traverse::app
