#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "traverse/pipeline/estimator.hpp"
#include "traverse/pipeline/preset.hpp"
#include "traverse/pipeline/run_contents.hpp"

namespace traverse::replay {

/// What replay needs of run.json.
struct RunFacts {
  std::filesystem::path recording;
  std::vector<std::string> command;  ///< the run's command line
  pipeline::PresetRequest preset;    ///< that gives the run's configuration
  std::size_t first_frame = 0;
  std::size_t frames = 0;  ///< with a pose
};

/// Of a run that was read. \throws files::InputError if the record names no recording
RunFacts run_facts(const pipeline::RunContents& run);

/// The frames of a run folder in place of an estimator: poses and health records as the run wrote
/// them, given out with the scans that they belong to. Nothing is estimated.
/// \param estimator the run's own, unused yet: it tells how a scan was corrected
std::unique_ptr<pipeline::Estimator> make_run_estimator(
    const pipeline::RunContents& run, std::unique_ptr<pipeline::Estimator> estimator);

}  // namespace traverse::replay
