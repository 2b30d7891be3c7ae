#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "traverse/pipeline/estimator.hpp"
#include "traverse/pipeline/preset.hpp"
#include "traverse/pipeline/run_folder.hpp"

namespace traverse::replay {

/// What replay needs of run.json.
struct RunFacts {
  std::filesystem::path recording;
  std::vector<std::string> command;  ///< the run's command line
  pipeline::PresetRequest preset;    ///< that gives the run's configuration
  std::size_t first_frame = 0;
  std::size_t frames = 0;  ///< with a pose
};

/// \throws files::InputError if run.json is not there or is not one.
RunFacts read_run_facts(const pipeline::RunFolder& folder);

/// The frames of a run folder in place of an estimator: poses and health records as the run wrote
/// them, given out with the scans that they belong to. Nothing is estimated.
/// \param estimator the run's own, unused yet: it tells how a scan was corrected
/// \throws files::InputError if the folder's files cannot be read or do not agree.
std::unique_ptr<pipeline::Estimator> make_run_estimator(
    const pipeline::RunFolder& folder, std::unique_ptr<pipeline::Estimator> estimator);

}  // namespace traverse::replay
