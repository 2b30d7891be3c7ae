#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "traverse/batch/plan.hpp"

namespace traverse::batch {

/// The plan's `pipelines` with their grids, each point of which the preset takes.
/// \param notes gets what the user should know of their settings
/// \throws files::InputError with file and line.
std::vector<PlannedPipeline> read_pipelines(const config::Document& plan,
                                            const std::filesystem::path& folder,
                                            const std::filesystem::path& share_folder,
                                            std::vector<std::string>& notes);

}  // namespace traverse::batch
