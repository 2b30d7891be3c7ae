#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace traverse::batch {

/// Runs a program of the PATH and returns what it printed.
/// \param folder takes the output meanwhile
/// \throws std::runtime_error with what it printed if it fails or is not there.
std::string command_output(const std::vector<std::string>& words,
                           const std::filesystem::path& folder);

/// How long to wait before each further try.
using Waits = std::vector<std::chrono::milliseconds>;

/// The same of a command of Slurm, tried again where its controller was busy or away for a moment.
/// \param stop once it is true there is no further try
/// \throws std::runtime_error as above, with the number of tries, for other failures and when the
/// last wait did not help
std::string patient_output(const std::vector<std::string>& words,
                           const std::filesystem::path& folder, const Waits& waits,
                           const std::atomic<bool>& stop);

/// Whether Slurm's message tells of a controller that may answer later.
bool is_passing(const std::string& message);

}  // namespace traverse::batch
