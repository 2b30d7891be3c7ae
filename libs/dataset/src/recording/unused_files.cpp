#include "recording/unused_files.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "kitti/kitti_calibration.hpp"

namespace traverse::dataset {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestLookedAt = 200'000'000;  // bytes
constexpr std::size_t kMostTold = 3;
constexpr std::array<std::string_view, 4> kTextFiles{".tum", ".txt", ".csv", ".kitti"};
/// In the name of a trajectory that is true, or held for it.
constexpr std::array<std::string_view, 5> kReferenceWords{"pose", "truth", "reference", "traj",
                                                          "groundtruth"};
/// Of a file beside others' recordings, where only a name without more is this one's.
constexpr std::array<std::string_view, 8> kWholeNames{
    "poses", "gt", "groundtruth", "ground_truth", "truth", "reference", "trajectory", "traj"};
constexpr std::array<std::string_view, 3> kLidarWords{"velo", "lidar", "laser"};
/// Of frames that no option names.
constexpr std::array<std::string_view, 2> kOtherFrames{"imu", "oxts"};

std::string in_lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

template <typename Words>
bool has_any(const std::string& text, const Words& words) {
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return text.find(word) != std::string::npos; });
}

/// "gt" between others than letters: in "gt_lidar", not in "length".
bool has_word_gt(const std::string& text) {
  const auto is_letter = [&](std::size_t i) {
    return i < text.size() && std::isalpha(static_cast<unsigned char>(text[i])) != 0;
  };
  for (std::size_t at = text.find("gt"); at != std::string::npos; at = text.find("gt", at + 1)) {
    if ((at == 0 || !is_letter(at - 1)) && !is_letter(at + 2)) return true;
  }
  return false;
}

bool is_readable_text(const fs::path& file) {
  std::error_code failure;
  const std::string extension = in_lower_case(file.extension().string());
  const bool is_text =
      std::find(kTextFiles.begin(), kTextFiles.end(), extension) != kTextFiles.end();
  return is_text && fs::is_regular_file(file, failure) &&
         fs::file_size(file, failure) <= kLargestLookedAt && !failure;
}

std::vector<fs::path> text_files_in(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder, failure)) {
    if (is_readable_text(entry.path())) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// The folder that the recording is, or stands in.
fs::path folder_of(const RecordingInfo& info) {
  if (fs::is_directory(info.path)) return info.path;
  return info.path.has_parent_path() ? info.path.parent_path() : fs::path(".");
}

bool belongs_to(const RecordingInfo& info, const fs::path& file) {
  if (fs::is_directory(info.path)) return true;
  const std::string stem = in_lower_case(file.stem().string());
  return file.filename().string().starts_with(info.path.stem().string()) ||
         std::find(kWholeNames.begin(), kWholeNames.end(), stem) != kWholeNames.end();
}

bool has_fact_about(const RecordingInfo& info, const fs::path& file) {
  const std::string name = file.filename().string();
  return std::any_of(info.facts.begin(), info.facts.end(), [&](const Fact& fact) {
    return fact.value.find(name) != std::string::npos ||
           fact.reason.find(name) != std::string::npos;
  });
}

std::string quoted(const fs::path& path) {
  const std::string text = path.string();
  return text.find_first_of(" '\"()&;") == std::string::npos ? text : "\"" + text + "\"";
}

/// What the file would be as a reference: "108 poses, one for each scan"; nothing if it is none.
std::optional<std::string> as_reference(const fs::path& file, std::size_t scans) {
  const std::string name = in_lower_case(file.stem().string());
  const bool is_named_so =
      has_any(name, kReferenceWords) || has_word_gt(name) || file.extension() == ".tum";
  if (!is_named_so || has_any(name, kOtherFrames)) return std::nullopt;
  try {
    const TrajectoryFormat format = detect_trajectory_format(file);
    const std::size_t poses = read_trajectory(file, format).size();  // throws where it is none
    if (poses == 0) return std::nullopt;
    if (format != TrajectoryFormat::kKitti) return fmt::format("{} poses with stamps", poses);
    if (poses != scans) return std::nullopt;
    return fmt::format("{} poses, one for each scan", poses);
  } catch (const files::InputError&) {
    return std::nullopt;
  }
}

/// What moves along it, by its name.
std::string frame_option(const fs::path& file) {
  const std::string name = in_lower_case(file.stem().string());
  if (has_any(name, kLidarWords)) return " --reference-frame lidar";
  const bool is_camera = name.find("cam") != std::string::npos;
  return is_camera ? " --reference-frame camera" : "";
}

void note_references(RecordingInfo& info, const std::vector<fs::path>& files, std::size_t scans) {
  std::size_t told = 0;
  for (const fs::path& file : files) {
    if (told == kMostTold) return;
    if (!belongs_to(info, file) || has_fact_about(info, file)) continue;
    const auto poses = as_reference(file, scans);
    if (!poses) continue;
    info.facts.push_back({kNotUsed, fmt::format("{}: {}", file.filename().string(), *poses),
                          fmt::format("looks like a reference: --reference {}{}", quoted(file),
                                      frame_option(file))});
    ++told;
  }
}

void note_calibrations(RecordingInfo& info, const std::vector<fs::path>& files) {
  for (const fs::path& file : files) {
    const bool is_named_so =
        in_lower_case(file.filename().string()).find("calib") != std::string::npos;
    if (!is_named_so || !belongs_to(info, file) || has_fact_about(info, file)) continue;
    try {
      const CameraCalibration calibration = read_camera_calibration(file);
      info.facts.push_back({kNotUsed,
                            fmt::format("{}: {}", file.filename().string(), calibration.how),
                            fmt::format("looks like the calibration of the camera: --recording "
                                        "calibration={}",
                                        quoted(file.filename()))});
      return;
    } catch (const files::InputError&) {
      continue;
    }
  }
}

/// The files that statements name.
std::vector<std::string> named_files(const config::Document& statements) {
  std::vector<std::string> names;
  for (const config::Leaf& leaf : statements.leaves()) {
    if (!leaf.path.ends_with(".file") && leaf.path != "calibration") continue;
    names.push_back(config::Document::parse("file: " + leaf.text, "").scalar("file").value_or(""));
  }
  return names;
}

void note_statements(RecordingInfo& info, const fs::path& folder, const OpenOptions& options) {
  std::error_code failure;
  const fs::path sidecar = fs::is_directory(info.path)
                               ? info.path / "traverse.yaml"
                               : fs::path(info.path).replace_extension(".traverse.yaml");
  if (options.statements_file || fs::exists(sidecar, failure)) return;
  for (const fs::path& file : fitting_statements(folder, options.share_folder)) {
    info.facts.push_back({kNotUsed,
                          fmt::format("{}: all that it names is here, {}", file.filename().string(),
                                      fmt::join(named_files(config::Document::load(file)), ", ")),
                          fmt::format("statements that fit: --recording-config {}", quoted(file))});
  }
}

}  // namespace

std::vector<fs::path> fitting_statements(const fs::path& folder, const fs::path& share_folder) {
  std::vector<fs::path> fitting;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(share_folder / "recordings", failure)) {
    if (entry.path().extension() != ".yaml") continue;
    const auto names = named_files(config::Document::load(entry.path()));
    const bool fits =
        !names.empty() && std::all_of(names.begin(), names.end(), [&](const std::string& name) {
          return fs::is_regular_file(folder / name);
        });
    if (fits) fitting.push_back(entry.path());
  }
  std::sort(fitting.begin(), fitting.end());
  return fitting;
}

void note_unused_files(RecordingInfo& info, const OpenOptions& options,
                       const std::optional<Reference>& reference, std::size_t scans) {
  const fs::path folder = folder_of(info);
  note_statements(info, folder, options);
  const std::vector<fs::path> files = text_files_in(folder);
  if (!reference && options.wants_reference) note_references(info, files, scans);
  const bool has_lidar = info.rig.first(sensors::SensorKind::kLidar) != nullptr;
  if (has_lidar && !info.T_body_camera) note_calibrations(info, files);
}

}  // namespace traverse::dataset
