#include "traverse/dataset/open_recording.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "traverse/dataset/foreign_file.hpp"
#include "traverse/dataset/recording_formats.hpp"
#include "traverse/files/input_error.hpp"

#include "recording/lidars_as_one.hpp"

namespace traverse::dataset {

using files::InputError;
using files::Place;

namespace {

namespace fs = std::filesystem;

/// "a folder with velodyne/*.bin (KITTI odometry), ...": what a folder, or a file, may be.
std::string known_formats(bool is_folder) {
  std::string text = "a recording: ";
  for (const RecordingFormat& format : recording_formats()) {
    if (format.is_folder != is_folder) continue;
    if (!text.ends_with(": ")) text += ", ";
    text += fmt::format("{} ({})", format.recognised_by, format.name);
  }
  return text;
}

/// Results have clouds too, which are no scans.
void refuse_results(const fs::path& folder) {
  if (fs::is_regular_file(folder / "run.json") && fs::exists(folder / "trajectory.tum")) {
    throw InputError(folder, Place::whole_file(), "a recording",
                     "the folder of a run (run.json names its recording; `traverse info` shows "
                     "the run)");
  }
  if (fs::is_regular_file(folder / "map.json") && fs::exists(folder / "map.simplemap")) {
    throw InputError(folder, Place::whole_file(), "a recording", "a map that `traverse map` made");
  }
}

/// "a folder with recordings in it: open one of them: a.rawlog, b.bag and 3 more"
std::string named_recordings(const std::vector<fs::path>& recordings) {
  constexpr std::size_t kMostNamed = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(recordings.size(), kMostNamed); ++i) {
    text += (i == 0 ? "" : ", ") + recordings[i].filename().string();
  }
  if (recordings.size() > kMostNamed) {
    text += fmt::format(" and {} more", recordings.size() - kMostNamed);
  }
  return "a folder with recordings in it: open one of them: " + text;
}

std::string found_in_folder(const fs::path& folder) {
  return fs::is_empty(folder) ? "an empty folder" : "a folder with none of these";
}

std::string found_in_file(const fs::path& file) {
  std::array<char, 16> bytes{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), bytes.size());
  const std::string_view start(bytes.data(), static_cast<std::size_t>(stream.gcount()));
  return start.empty() ? "an empty file" : "a file that begins with " + files::in_quotes(start);
}

/// What stands there in place of a recording, and what to do about it where that is known.
std::string found_instead(const fs::path& path, bool is_folder) {
  if (is_folder) {
    const auto recordings = recordings_in(path);
    if (!recordings.empty()) return named_recordings(recordings);
  }
  if (const auto foreign = foreign_format(path)) {
    return fmt::format("{}: {}", foreign->name, foreign->action);
  }
  return is_folder ? found_in_folder(path) : found_in_file(path);
}

std::unique_ptr<Source> open_by_format(const fs::path& path, const OpenOptions& options) {
  const bool is_folder = fs::is_directory(path);
  if (is_folder) refuse_results(path);
  for (const RecordingFormat& format : recording_formats()) {
    if (format.is_folder == is_folder && format.recognises(path)) {
      return format.open(path, options, format.name);
    }
  }
  throw InputError(
      path, Place::whole_file(), known_formats(is_folder),
      found_instead(path, is_folder) + "; `traverse info --formats` tells more of each");
}

}  // namespace

std::unique_ptr<Source> open_recording(const fs::path& path, const OpenOptions& options) {
  std::error_code failure;
  const fs::path whole = path.has_filename() ? path : path.parent_path();  // "drive/" is "drive"
  if (!fs::exists(whole, failure)) {
    throw InputError(path, Place::whole_file(), "a recording",
                     failure ? failure.message() : "no such file or folder");
  }
  try {
    return with_lidars_as_one(open_by_format(whole, options));
  } catch (const fs::filesystem_error& error) {
    throw InputError(error.path1(), Place::whole_file(), "a readable recording",
                     error.code().message());
  }
}

}  // namespace traverse::dataset
