#include "captures/ouster_choice.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

namespace traverse::dataset {

namespace fs = std::filesystem;

namespace {

constexpr const char* kMetadataKey = "lidar.metadata";

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace

std::optional<OusterChoice> stated_ouster(const Statements& statements) {
  if (!statements.states(kMetadataKey)) return std::nullopt;
  const fs::path file = statements.find_file(kMetadataKey, statements->lidar_metadata);
  return OusterChoice{packets::load_ouster_metadata(file), file.string(),
                      *statements.origin(kMetadataKey)};
}

std::optional<OusterChoice> ouster_beside(const fs::path& recording) {
  constexpr std::uintmax_t kMost = 4 << 20;
  const bool is_folder = fs::is_directory(recording);
  const fs::path parent = recording.parent_path().empty() ? fs::path(".") : recording.parent_path();
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(is_folder ? recording : parent)) {
    if (!entry.is_regular_file() || entry.path().extension() != ".json") continue;
    if (entry.file_size() > kMost || !packets::is_ouster_metadata(text_of(entry.path()))) continue;
    found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  if (found.size() > 1) {
    const fs::path name = is_folder ? recording.filename() : recording.stem();
    std::erase_if(found, [&](const fs::path& file) { return file.stem() != name; });
  }
  if (found.size() != 1) return std::nullopt;
  return OusterChoice{packets::load_ouster_metadata(found.front()), found.front().string(),
                      is_folder ? "found in the folder" : "found beside the recording"};
}

void note_ouster(const OusterChoice& choice, std::vector<Fact>& facts) {
  facts.push_back(
      {"Ouster metadata",
       fmt::format("{} ({}, {}, {})", choice.from, choice.metadata.product,
                   choice.metadata.lidar_mode, packets::name_of(choice.metadata.profile)),
       choice.reason});
}

geometry::Pose3 ouster_imu_mounting(const packets::OusterMetadata& metadata) {
  const std::array<double, 16>& T = metadata.imu_to_sensor;
  Eigen::Matrix3d R;
  Eigen::Vector3d t;
  for (std::size_t row = 0; row < 3; ++row) {
    const auto i = static_cast<Eigen::Index>(row);
    for (std::size_t column = 0; column < 3; ++column) {
      R(i, static_cast<Eigen::Index>(column)) = T[4 * row + column];
    }
    t[i] = T[4 * row + 3] * 1e-3;
  }
  return {R, t};
}

}  // namespace traverse::dataset
