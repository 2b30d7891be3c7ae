#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace traverse::dataset {

/// A kind of file that no reader knows, told by its first bytes.
struct ForeignFormat {
  std::string_view code;    ///< "foreign_laz", stable
  std::string_view name;    ///< "LAZ, a compressed LAS point cloud"
  std::string_view action;  ///< what to do, one step: "pdal translate FILE.laz FILE.ply"
};

/// What a file is that no reader takes, or the first such file of a folder; nothing where its first
/// bytes are of none that is known.
std::optional<ForeignFormat> foreign_format(const std::filesystem::path& path);

/// Every kind that foreign_format() tells, for the documentation.
std::span<const ForeignFormat> foreign_formats();

}  // namespace traverse::dataset
