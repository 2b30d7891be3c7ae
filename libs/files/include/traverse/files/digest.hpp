#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace traverse::files {

/// SHA-256 as 64 lower-case hexadecimal digits.
std::string sha256_of_text(std::string_view text);

/// SHA-256 of a file's bytes, read in pieces. \throws InputError if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

/// What a recording on disk is: its bytes and their digest.
struct ContentId {
  std::uintmax_t bytes = 0;
  std::string sha256;
};

/// Of a file: its size and digest. Of a folder: the sum of sizes, and the digest of the sorted
/// list "digest  relative/path\n" of all regular files below it, as `sha256sum` prints it, so that
/// a reviewer can repeat it with: find . -type f -printf '%P\n' | LC_ALL=C sort | xargs sha256sum |
/// sha256sum. \throws InputError
ContentId content_id(const std::filesystem::path& file_or_folder);

}  // namespace traverse::files
