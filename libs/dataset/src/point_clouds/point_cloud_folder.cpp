#include <algorithm>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/statistics/quantile.hpp"

#include "point_clouds/cloud_scan.hpp"
#include "point_clouds/field_values.hpp"
#include "recording/folder_opening.hpp"
#include "recording/stamp_files.hpp"
#include "recording/unused_files.hpp"

namespace traverse::dataset {

using files::InputError;
using geometry::Stamp;

namespace {

namespace fs = std::filesystem;

constexpr const char* kLidar = "lidar";

/// A stamp written as a file's name: seconds with decimals, or whole nanoseconds or microseconds
/// told apart by their size. Smaller whole numbers are counts, not times.
std::optional<StampText> stamp_in_name(const std::string& name) {
  const auto whole = files::parse_integer(name);
  if (!whole && name.find('.') == std::string::npos) return std::nullopt;
  if (whole) {
    const auto unit = geometry::unix_time_unit(static_cast<double>(*whole));
    if (!unit || *unit < geometry::UnixTimeUnit::kMicroseconds) return std::nullopt;
  }
  return parse_stamp(name);
}

std::optional<std::vector<ScanFile>> stamp_by_name(const std::vector<fs::path>& files,
                                                   std::vector<Fact>& facts) {
  std::vector<ScanFile> scans;
  std::string form;
  for (const fs::path& file : files) {
    const auto stamp = stamp_in_name(file.stem().string());
    if (!stamp) return std::nullopt;
    if (form.empty()) form = stamp->form;
    scans.push_back({file, stamp->stamp});
  }
  std::stable_sort(scans.begin(), scans.end(), [](const ScanFile& a, const ScanFile& b) {
    return a.stamp->nanoseconds < b.stamp->nanoseconds;
  });
  facts.push_back({"scan stamps", "the files' names",
                   fmt::format("they are times ({}); there is no times file", form)});
  SensorStamps sensor{"scans", StampSequence::of(stamps_of(scans)),
                      [&](std::size_t scan) { return scans[scan].file.filename().string(); }};
  settle_steps(std::span(&sensor, 1), facts);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const RecordStamp& record = sensor.sequence.records[i];
    scans[i] = {scans[i].file, record.stamp, record.fault};
  }
  return scans;
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

/// The files of the kind that there are most of.
std::vector<fs::path> find_clouds(const fs::path& folder, std::vector<Fact>& facts) {
  std::vector<fs::path> pcd = files_with_extension(folder, ".pcd");
  std::vector<fs::path> ply = files_with_extension(folder, ".ply");
  const bool take_pcd = pcd.size() >= ply.size();
  const std::size_t left = take_pcd ? ply.size() : pcd.size();
  if (left > 0) {
    facts.push_back({"files left out", fmt::format("{} {}", left, take_pcd ? "PLY" : "PCD"),
                     take_pcd ? "there are at least as many PCD" : "there are more PLY"});
  }
  return take_pcd ? pcd : ply;
}

/// The last scan that can be read: it shows what the recording's files hold.
struct Example {
  PointCloud cloud;
  sensors::LidarScan scan;
};

Example find_example(const fs::path& folder, const std::vector<ScanFile>& scans) {
  constexpr std::size_t kMaxWithOneTime = 5;  // then the field tells no times
  std::string fault = "none";
  std::optional<Example> with_one_time;
  std::size_t count_with_one_time = 0;
  for (auto scan = scans.rbegin(); scan != scans.rend(); ++scan) {
    if (!scan->stamp) continue;
    try {
      Example example{read_point_cloud(scan->file), {}};
      example.scan = scan_from_cloud(example.cloud, *scan->stamp, std::nullopt, scan->file);
      if (!example.scan.empty() && !has_one_time(example.cloud)) return example;
      if (example.scan.empty()) {
        fault = "clouds without points";
        continue;
      }
      if (!with_one_time) with_one_time = std::move(example);
      if (++count_with_one_time == kMaxWithOneTime) break;
    } catch (const InputError& error) {
      fault = error.what();
    }
  }
  if (with_one_time) return std::move(*with_one_time);
  throw InputError(folder, files::Place::whole_file(),
                   "a point cloud with a stamp that can be read", fault);
}

double intensity_full_scale(const FieldValues& field) {
  switch (type_of(field)) {
    case ScalarType::kUint8:
      return 255;
    case ScalarType::kUint16:
      return 65535;
    default: {
      const std::vector<double> values = to_doubles(field);
      return *std::max_element(values.begin(), values.end()) <= 1 ? 1 : 255;
    }
  }
}

/// From one scan to the next, in the median.
double interval_of(const std::vector<ScanFile>& scans, double otherwise) {
  std::vector<double> intervals;
  std::optional<Stamp> last;
  for (const ScanFile& scan : scans) {
    if (scan.stamp && last) intervals.push_back(geometry::seconds_between(*last, *scan.stamp));
    if (scan.stamp) last = scan.stamp;
  }
  if (intervals.empty()) return otherwise;
  const double median = statistics::median(intervals);
  return median > 0 ? median : otherwise;
}

/// What the files themselves tell about the lidar.
ProfileChoice profile_from(const Example& example, bool has_time) {
  ProfileChoice choice;
  choice.reason = "default; from the fields of the last scan";
  choice.profile.time_source = has_time ? sensors::TimeSource::kData : sensors::TimeSource::kNone;
  const std::vector<std::uint16_t>& rings = example.scan.ring;
  if (rings.empty()) {
    choice.reason += ", which have no ring number";
  } else {
    choice.profile.rings = *std::max_element(rings.begin(), rings.end()) + 1;
  }
  if (const FieldValues* intensity = intensity_of(example.cloud)) {
    choice.profile.intensity_full_scale = intensity_full_scale(*intensity);
  }
  return choice;
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
  const Example example = find_example(folder, recording.scans);
  PointTimeHints hints;
  hints.scan_interval_s = interval_of(recording.scans, statements->period_s);
  if (const auto origin = statements.origin("point_time_unit_s")) {
    hints.stated_unit_s = statements->point_time_unit_s;
    hints.stated_in = *origin;
  }
  const auto time = find_point_time(example.cloud, example.scan.stamp, hints, info.facts);
  mount_lidar(
      info, kLidar,
      choose_profile(statements, options.share_folder, profile_from(example, time.has_value())),
      statements);
  recording.lidar = kLidar;

  set_camera(info, statements, folder / "calib.txt");
  recording.reference =
      choose_reference(info, statements, std::nullopt, stamps_of(recording.scans));
  note_unused_files(info, options, recording.reference, info.expected_scans);
  recording.read = [time, unit_m = statements->point_unit_m](const ScanFile& scan) {
    return in_metres(scan_from_cloud(read_point_cloud(scan.file), *scan.stamp, time, scan.file),
                     unit_m);
  };
  return make_folder_source(std::move(recording));
}

}  // namespace traverse::dataset
