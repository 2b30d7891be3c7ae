#pragma once

#include <filesystem>
#include <vector>

#include "traverse/batch/plan.hpp"

namespace traverse::batch {

/// The plan's `recordings`: globs spread out, generated ones once a seed.
/// \param folder that relative paths start from
/// \throws files::InputError with file and line.
std::vector<PlannedRecording> read_recordings(const config::Document& plan,
                                              const std::filesystem::path& folder,
                                              const SimulationCheck& simulation_error);

}  // namespace traverse::batch
