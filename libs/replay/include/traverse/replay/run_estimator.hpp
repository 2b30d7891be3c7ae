#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "traverse/pipeline/estimator.hpp"
#include "traverse/pipeline/preset.hpp"
#include "traverse/pipeline/run_contents.hpp"

namespace traverse::replay {

/// What replay needs of run.json.
struct RunFacts {
  std::filesystem::path recording;   ///< where it was found, or should be
  std::vector<std::string> command;  ///< the run's command line
  /// About the recording, from any folder; nothing: a run of version 0.1, whose command tells.
  std::optional<std::vector<std::string>> statements;
  std::string pipeline;
  std::vector<std::string> settings;  ///< "estimator=voxel_map", "solver.huber_m=0.2"; all of them
  /// Of a run of version 0.1, which does not tell its estimator: what it changed of its preset.
  std::optional<pipeline::PresetRequest> preset;
  std::size_t first_frame = 0;
  std::size_t frames = 0;  ///< with a pose
};

/// The configuration of the run. \param share_folder with the presets, for runs of version 0.1
/// \throws files::InputError for a preset or a setting that this program does not know
pipeline::Preset preset_of_run(const RunFacts& facts, const std::filesystem::path& share_folder);

/// Of a run that was read. \throws files::InputError if the record names no recording
RunFacts run_facts(const pipeline::RunContents& run);

/// The frames of a run folder in place of an estimator: poses and health records as the run wrote
/// them, given out with the scans that they belong to. Nothing is estimated.
/// \param estimator the run's own, unused yet: it tells how a scan was corrected
std::unique_ptr<pipeline::Estimator> make_run_estimator(
    const pipeline::RunContents& run, std::unique_ptr<pipeline::Estimator> estimator);

}  // namespace traverse::replay
