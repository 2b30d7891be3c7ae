#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/pipeline/preset.hpp"

#include "recording_options.hpp"

namespace traverse::app {

/// A run whose poses another program made.
struct ImportedRun {
  std::string trajectory;  ///< file or folder of a bag
  std::string name;        ///< of the program
  /// The settings of its pipeline, known when the recording has been opened.
  std::function<std::vector<std::string>(dataset::Source&)> assignments;
};

/// What the commands are told that write a run folder.
struct RunArguments {
  RecordingOptions recording;
  std::string folder;
  pipeline::PresetRequest preset;
  std::string reference;
  std::string reference_frame;
  std::string gnss_outages;
  std::optional<bool> slam;
  /// The poses of another program that are taken over, in place of a preset; nothing: estimated.
  std::optional<ImportedRun> imported;
  std::string map;  ///< run folder to localise in; empty: none
  std::vector<double> start;
  std::vector<std::string> accepted;  ///< codes of contradictions
  std::size_t first = 0;
  std::optional<std::size_t> last;
  int threads = 1;
  bool report = true;
  bool utm = false;
  bool las = false;
  std::optional<std::filesystem::path> budget;
  std::optional<std::filesystem::path> checkpoints;  ///< surveyed points, a prism, fixes
  std::vector<double> point;  ///< what stood over them, body frame; empty: the body's origin
  double points_time_offset_s = 0;
  bool hash = true;
  bool bench_factors = false;
  bool force = false;
  bool is_private = false;
};

/// Declares the options of every command that writes a run folder: where it is written, which
/// frames, what comes with it.
void add_run_folder_options(CLI::App& command, RunArguments& arguments);

/// Goes through the recording and writes the run folder; says what came of it.
/// \param command the command line, for the record
void make_run(RunArguments& arguments, const std::vector<std::string>& command);

}  // namespace traverse::app
