#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace traverse::batch {

/// Runs a program of the PATH and returns what it printed.
/// \param folder takes the output meanwhile
/// \throws std::runtime_error with what it printed if it fails or is not there.
std::string command_output(const std::vector<std::string>& words,
                           const std::filesystem::path& folder);

}  // namespace traverse::batch
