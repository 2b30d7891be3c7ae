#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "navigation_log/tables_beside.hpp"
#include "point_clouds/bin_points.hpp"
#include "point_clouds/cloud_lidar.hpp"
#include "point_clouds/name_stamps.hpp"
#include "recording/folder_opening.hpp"
#include "recording/stamp_files.hpp"
#include "recording/unused_files.hpp"

namespace traverse::dataset {

namespace {

namespace fs = std::filesystem;

constexpr const char* kLidar = "lidar";

/// The name without ".pcd", ".ply" or ".bin"; nuScenes has ".pcd.bin".
std::string name_of_scan(const fs::path& file) {
  fs::path stem = file.stem();
  if (stem.extension() == ".pcd") stem = stem.stem();
  return stem.string();
}

std::optional<std::vector<ScanFile>> stamp_by_name(const std::vector<fs::path>& files,
                                                   std::vector<Fact>& facts) {
  std::vector<std::string> names;
  for (const fs::path& file : files) names.push_back(name_of_scan(file));
  const auto found = stamps_in_names(names);
  if (!found) return std::nullopt;
  std::vector<ScanFile> scans;
  for (std::size_t i = 0; i < files.size(); ++i) scans.push_back({files[i], found->stamps[i]});
  std::stable_sort(scans.begin(), scans.end(), [](const ScanFile& a, const ScanFile& b) {
    return a.stamp->nanoseconds < b.stamp->nanoseconds;
  });
  facts.push_back({"scan stamps", "the files' names",
                   fmt::format("they are times ({}); there is no times file", found->form)});
  SensorStamps sensor{"scans", StampSequence::of(stamps_of(scans)),
                      [&](std::size_t scan) { return scans[scan].file.filename().string(); }};
  settle_steps(std::span(&sensor, 1), facts);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const RecordStamp& record = sensor.sequence.records[i];
    scans[i] = {scans[i].file, record.stamp, record.fault};
  }
  return scans;
}

bool is_bin(const fs::path& file) {
  const std::string extension = file.extension().string();
  return extension.size() == 4 && (extension[1] == 'b' || extension[1] == 'B');
}

std::vector<ScanFile> stamp_scans(const fs::path& folder, const std::vector<fs::path>& files,
                                  const Statements& statements, std::vector<Fact>& facts) {
  for (const char* name : {"times.txt", "timestamps.txt"}) {
    if (fs::exists(folder / name)) {
      const StampFile times = read_stamps(folder / name);
      return stamp_by_line(files, settled_stamps(times, "scans", facts), name_with_form(times),
                           "scan", facts);
    }
  }
  if (auto scans = stamp_by_name(files, facts)) return *scans;
  return stamp_by_period(files, statements, facts);
}

constexpr std::array<std::string_view, 3> kExtensions{".pcd", ".ply", ".bin"};

/// The files of the kind that there are most of.
std::vector<fs::path> find_clouds(const fs::path& folder, std::vector<Fact>& facts) {
  std::vector<fs::path> taken;
  std::vector<std::string> left;
  std::string_view taken_extension;
  for (const std::string_view extension : kExtensions) {
    std::vector<fs::path> found = files_with_extension(folder, extension);
    if (found.empty()) continue;
    std::size_t passed = found.size();
    std::string_view passed_extension = extension;
    if (found.size() > taken.size()) {
      passed = taken.size();
      passed_extension = taken_extension;
      taken = std::move(found);
      taken_extension = extension;
    }
    if (passed > 0) left.push_back(fmt::format("{} *{}", passed, passed_extension));
  }
  if (!left.empty()) {
    facts.push_back({"files left out", fmt::format("{}", fmt::join(left, ", ")),
                     fmt::format("there are {} *{}", taken.size(), taken_extension)});
  }
  return taken;
}

}  // namespace

std::unique_ptr<Source> open_point_cloud_folder(const fs::path& folder, const OpenOptions& options,
                                                std::string_view format) {
  const Statements statements(folder / "traverse.yaml", options, folder);
  FolderRecording recording;
  RecordingInfo& info = recording.info;
  info = begin_info(folder, format, statements, "lidar");
  set_motion_compensation(info, statements, false, "default, not stated");

  const std::vector<fs::path> files = find_clouds(folder, info.facts);
  recording.scans = stamp_scans(folder, files, statements, info.facts);
  info.expected_scans = recording.scans.size();
  CloudReader read = read_point_cloud;
  if (is_bin(files.front())) {
    read = [layout = bin_layout(files, statements, info.facts)](const fs::path& file) {
      return read_bin_points(file, layout);
    };
  }
  recording.read =
      mount_cloud_lidar(info, kLidar, recording.scans, std::move(read), statements, options);
  recording.lidar = kLidar;

  set_camera(info, statements, folder / "calib.txt");
  recording.reference =
      choose_reference(info, statements, std::nullopt, stamps_of(recording.scans));
  add_tables(recording, folder, statements);
  note_unused_files(info, options, recording.reference, info.expected_scans);
  return make_folder_source(std::move(recording));
}

}  // namespace traverse::dataset
