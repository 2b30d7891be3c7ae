#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "traverse/geometry/stamp.hpp"

namespace traverse::dataset {

/// Seconds ("0.1033", "1317042145.964") or, as in KITTI raw, a date and time of day taken as UTC
/// ("2011-09-26 13:02:25.964389445"). Nothing if `text` is neither.
std::optional<geometry::Stamp> parse_stamp(std::string_view text);

/// One stamp a line. A line that holds none keeps its place as nothing, so that the others keep
/// theirs; blank lines at the end and '#' comments do not count.
/// \throws files::InputError if the file cannot be read.
std::vector<std::optional<geometry::Stamp>> read_stamps(const std::filesystem::path& file);

}  // namespace traverse::dataset
