#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace traverse::files {

/// The whole file in one read. \throws InputError if it cannot be read.
std::vector<std::byte> read_bytes(const std::filesystem::path& path);

}  // namespace traverse::files
