#pragma once

#include <filesystem>
#include <fstream>

namespace traverse::files {

/// \throws InputError with the system's reason; opening a folder would only fail at the first read.
std::ifstream open_for_reading(const std::filesystem::path& path);

}  // namespace traverse::files
