#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "traverse/batch/plan.hpp"
#include "traverse/config/document.hpp"

namespace traverse::batch {

/// An entry of `pipelines` that names a recipe (`system: kiss-icp`): the recipe with the entry's
/// own keys over it. \throws files::InputError with the plan's line if there is none of that name
config::Document with_recipe(config::Document entry, const std::filesystem::path& share_folder);

/// An entry of `pipelines` that is a command. \throws files::InputError with the plan's line
PlannedPipeline read_command(const config::Document& entry, const std::filesystem::path& folder);

/// That each of its placeholders stands for something. \param settings of a point of its grid
/// \throws files::InputError with the plan's line
void check_command(const PlannedPipeline& pipeline, const std::vector<std::string>& settings);

/// The formats that `traverse convert` makes for commands, and the ending of what it writes.
std::string_view ending_of_format(std::string_view format);

}  // namespace traverse::batch
