#include "bags/bag_files.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "traverse/config/document.hpp"
#include "traverse/dataset/foreign_file.hpp"
#include "traverse/files/input_error.hpp"

#include "bags/bag_source.hpp"
#include "point_clouds/scan_files.hpp"

namespace traverse::dataset {

using files::InputError;
using files::Place;

namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 2> kRos2Extensions{".mcap", ".db3"};
constexpr const char* kPacked = ".zstd";  // of files that rosbag2 packed as a whole

bool is_called(const fs::path& file, std::string_view wanted) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == wanted;
}

std::vector<fs::path> packed_files(const fs::path& folder) {
  std::vector<fs::path> packed;
  for (const fs::path& file : files_with_extension(folder, kPacked)) {
    for (const char* extension : kRos2Extensions) {
      if (is_called(file.stem(), extension)) packed.push_back(file);
    }
  }
  return packed;
}

/// Files that metadata.yaml names and that are not there.
std::vector<std::string> missing_files(const fs::path& folder, std::vector<Fact>& facts) {
  std::vector<std::string> missing;
  const fs::path metadata = folder / "metadata.yaml";
  if (!fs::is_regular_file(metadata)) return missing;
  try {
    for (const config::Leaf& leaf : config::Document::load(metadata).leaves()) {
      if (!leaf.items || leaf.path.find("relative_file_paths") == std::string::npos) continue;
      for (const std::string& item : *leaf.items) {
        const auto name = config::Document::parse("file: " + item, "").scalar("file");
        if (name && !fs::exists(folder / *name)) missing.push_back(*name);
      }
    }
  } catch (const InputError& error) {
    facts.push_back({"metadata.yaml", "not used", error.what()});
  }
  return missing;
}

}  // namespace

bool is_ros1_bag_file(const fs::path& file) {
  // Of version 1, encrypted, or another kind of file behind the name: told as such.
  return (is_called(file, ".bag") || bags::is_ros1_bag(file)) && !foreign_format(file);
}
bool is_folder_of_ros1_bags(const fs::path& folder) {
  return !files_with_extension(folder, ".bag").empty();
}
bool is_ros2_bag_folder(const fs::path& folder) {
  return std::any_of(kRos2Extensions.begin(), kRos2Extensions.end(),
                     [&](const char* extension) {
                       return !files_with_extension(folder, extension).empty();
                     }) ||
         !packed_files(folder).empty();
}
bool is_ros2_database(const fs::path& file) {
  return is_called(file, ".db3") || bags::is_sqlite(file);
}
bool is_mcap_file(const fs::path& file) { return is_called(file, ".mcap") || bags::is_mcap(file); }

std::vector<fs::path> bag_files(const fs::path& path) {
  if (!fs::is_directory(path)) return {path};
  for (const char* extension : {".bag", ".mcap", ".db3"}) {
    auto found = files_with_extension(path, extension);
    if (!found.empty()) return found;
  }
  return {};
}

std::unique_ptr<bags::MessageContainer> open_bag_files(const fs::path& path,
                                                       std::vector<Fact>& facts) {
  const std::vector<fs::path> files = bag_files(path);
  if (files.empty()) {
    const auto packed = packed_files(path);
    throw InputError(packed.empty() ? path : packed.front(), Place::whole_file(),
                     "files that are not packed as a whole",
                     fmt::format("{}; `zstd -d {}` unpacks them",
                                 packed.empty() ? "none" : packed.front().filename().string(),
                                 (path / "*.zstd").string()));
  }
  std::vector<std::unique_ptr<bags::MessageContainer>> parts;
  std::optional<InputError> first_error;
  for (const fs::path& file : files) {
    try {
      parts.push_back(bags::open_container(file));
    } catch (const InputError& error) {
      if (!first_error) first_error = error;
      facts.push_back({"file left out", file.filename().string(), error.what()});
    }
  }
  if (parts.empty()) throw *first_error;
  if (fs::is_directory(path)) {
    for (const std::string& name : missing_files(path, facts)) {
      facts.push_back({"file left out", name, "metadata.yaml names it, but it is not there"});
    }
  }
  return bags::merge(std::move(parts));
}

}  // namespace traverse::dataset
