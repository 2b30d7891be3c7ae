#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "traverse/batch/planned_command.hpp"
#include "traverse/config/document.hpp"

namespace traverse::batch {

/// The image that a plan names: a file relative to the plan, which apptainer runs, or the name of
/// one that podman has here. Nothing is fetched.
/// \throws files::InputError with the plan's line if the program that runs it or the image is not
/// there
PlannedContainer find_container(const std::string& image, const std::filesystem::path& folder,
                                const config::Origin& origin);

/// The command as the container's program starts it, for /bin/sh, in the working folder.
/// \param readable files and folders that it may read, at their own places
std::string in_container(const PlannedContainer& container, const std::string& command,
                         const std::vector<std::filesystem::path>& readable);

}  // namespace traverse::batch
