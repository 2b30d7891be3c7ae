#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace traverse::files {

/// Key of a JSON document's second line, which states the SHA-256 of all its other lines. To
/// repeat: `grep -v sha256_of_other_lines FILE | sha256sum`.
inline constexpr std::string_view kSealKey = "sha256_of_other_lines";

/// The document with such a line. \param json an object with members, as `dump(1)` of the JSON
/// library writes it: "{" alone on its first line \throws std::invalid_argument for other text
std::string sealed_json(std::string_view json);

/// Whether the document is as it was sealed. \param file for messages
/// \returns false if it has no such line: earlier versions wrote none
/// \throws InputError if it was changed, and as JsonDocument::parse()
bool require_seal(std::string_view text, const std::filesystem::path& file);

}  // namespace traverse::files
