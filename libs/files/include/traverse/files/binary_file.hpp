#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace traverse::files {

/// Of a file, or of what is decompressed in one piece: more is refused before memory is taken.
inline constexpr std::uint64_t kMostBytesAtOnce = std::uint64_t{1} << 30;

/// The whole file in one read. \throws InputError if it cannot be read or is larger than
/// kMostBytesAtOnce.
std::vector<std::byte> read_bytes(const std::filesystem::path& path);

}  // namespace traverse::files
