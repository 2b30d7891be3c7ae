#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "traverse/config/document.hpp"
#include "traverse/config/settings.hpp"
#include "traverse/dataset/open_recording.hpp"

#include "recording/lidars_as_one.hpp"

namespace traverse::dataset {

namespace {

namespace fs = std::filesystem;

/// Keys whose values may be files outside the recording's folder.
constexpr std::array<std::string_view, 4> kFileKeys{"reference.file", "calibration", "sensor",
                                                    "lidar.metadata"};

/// The file's absolute path, if `value` names one that is not beside the recording.
std::optional<std::string> file_elsewhere(const config::Leaf& leaf, const fs::path& folder) {
  if (std::find(kFileKeys.begin(), kFileKeys.end(), leaf.path) == kFileKeys.end()) {
    return std::nullopt;
  }
  const auto value = config::Document::parse("file: " + leaf.text, "").scalar("file");
  if (!value || fs::is_regular_file(folder / *value)) return std::nullopt;
  const fs::path stated_in =
      leaf.origin.line == 0 ? fs::path() : fs::path(leaf.origin.source).parent_path();
  const fs::path file = fs::absolute(stated_in / *value).lexically_normal();
  if (!fs::is_regular_file(file)) return std::nullopt;
  return file.string();
}

}  // namespace

std::vector<std::string> lasting_statements(const fs::path& recording, const OpenOptions& options) {
  config::Document document;
  if (options.statements_file) {
    document.overlay(config::Document::load(*options.statements_file));
  }
  for (const std::string& statement : options.statements) {
    document.set(with_list_as_text(statement), "--recording");
  }
  const fs::path whole = recording.has_filename() ? recording : recording.parent_path();
  const fs::path folder = fs::is_directory(whole) ? whole : whole.parent_path();
  std::vector<std::string> statements;
  for (const config::Leaf& leaf : document.leaves()) {
    const auto elsewhere = file_elsewhere(leaf, folder);
    statements.push_back(leaf.path + "=" + (elsewhere ? config::to_text(*elsewhere) : leaf.text));
  }
  return statements;
}

}  // namespace traverse::dataset
