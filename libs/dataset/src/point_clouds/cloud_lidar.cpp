#include "point_clouds/cloud_lidar.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "traverse/files/input_error.hpp"
#include "traverse/statistics/quantile.hpp"

#include "point_clouds/point_fields.hpp"
#include "point_clouds/point_statements.hpp"
#include "recording/folder_opening.hpp"

namespace traverse::dataset {

using files::InputError;
using geometry::Stamp;

namespace {

namespace fs = std::filesystem;

/// A scan that shows what the recording's files hold.
struct ExampleScan {
  PointCloud cloud;
  Stamp stamp;
};

/// A few of the scans that can be read and have points, the last one first: there absolute times
/// are largest. Such that have one time for all points only if no other is found.
std::vector<ExampleScan> find_examples(const fs::path& folder, const std::vector<ScanFile>& scans,
                                       const CloudReader& read) {
  constexpr std::size_t kWanted = 3;
  constexpr std::size_t kMostWithOneTime = 5;  // then the field tells no times
  std::vector<const ScanFile*> order;          // each once, those spread over the recording first
  std::vector<bool> is_listed(scans.size(), false);
  const auto list = [&](std::size_t i) {
    if (!is_listed[i]) order.push_back(&scans[i]);
    is_listed[i] = true;
  };
  const std::size_t count = scans.size();
  for (const std::size_t i : {count - 1, count / 2, std::size_t{0}, count / 4, 3 * count / 4})
    list(i);
  const std::size_t spread = order.size();
  for (std::size_t i = count; i-- > 0;) list(i);
  std::string fault = "none";
  std::vector<ExampleScan> examples;
  std::vector<ExampleScan> with_one_time;
  std::size_t looked_at = 0;
  for (const ScanFile* scan : order) {
    ++looked_at;
    if (looked_at > spread && !examples.empty()) break;
    if (!scan->stamp) continue;
    try {
      ExampleScan example{read(scan->file), *scan->stamp};
      const PointColumns columns = columns_of(example.cloud);
      static_cast<void>(
          scan_of_columns(columns, example.stamp, coordinates_of(columns), scan->file));
      if (columns.points == 0) {
        fault = "clouds without points";
      } else if (!has_one_time(columns)) {
        examples.push_back(std::move(example));
        if (examples.size() == kWanted) break;
      } else {
        with_one_time.push_back(std::move(example));
        if (with_one_time.size() == kMostWithOneTime && examples.empty()) break;
      }
    } catch (const InputError& error) {
      fault = error.what();
    }
  }
  if (!examples.empty()) return examples;
  if (!with_one_time.empty()) return with_one_time;
  throw InputError(folder, files::Place::whole_file(),
                   "a point cloud with a stamp that can be read", fault);
}

double intensity_full_scale(const PointColumns& points, const PointColumn& field) {
  switch (field.type) {
    case ScalarType::kUint8:
      return 255;
    case ScalarType::kUint16:
      return 65535;
    default: {
      const std::vector<double> values = doubles_of(points, field);
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

/// What the files themselves tell about the lidar. \param example the scan that is judged by
ProfileChoice profile_from(const PointSample& example, const PointFields& fields,
                           const fs::path& folder) {
  ProfileChoice choice;
  choice.reason = "default; from the fields of the last scan";
  choice.profile.time_source =
      fields.time ? sensors::TimeSource::kData : sensors::TimeSource::kNone;
  PointFields without_times = fields;
  without_times.time.reset();
  without_times.needs_rings = false;
  const std::vector<std::uint16_t> rings =
      scan_of_columns(example.points, example.stamp, without_times, folder).ring;
  if (rings.empty()) {
    choice.reason += ", which have no ring number";
  } else {
    choice.profile.rings = *std::max_element(rings.begin(), rings.end()) + 1;
  }
  if (const PointColumn* intensity = example.points.find(fields.intensity)) {
    choice.profile.intensity_full_scale = intensity_full_scale(example.points, *intensity);
  }
  return choice;
}

}  // namespace

ScanReader mount_cloud_lidar(RecordingInfo& info, const std::string& label,
                             const std::vector<ScanFile>& scans, CloudReader read,
                             const Statements& statements, const OpenOptions& options) {
  const std::vector<ExampleScan> examples = find_examples(info.path, scans, read);
  std::vector<PointSample> samples;
  for (const ExampleScan& example : examples) {
    samples.push_back({columns_of(example.cloud), example.stamp});
  }
  PointFieldHints hints = stated_point_fields(statements);
  hints.scan_interval_s = interval_of(scans, statements->period_s);
  hints.recording = info.path;
  PointFields fields = interpret_points(samples, hints, info.facts);
  mount_lidar(info, label,
              choose_profile(statements, options.share_folder,
                             profile_from(samples.front(), fields, info.path)),
              statements);
  const sensors::LidarProfile& profile = *info.rig.sensors.back().lidar;
  fields.needs_rings = profile.ring_source == sensors::RingSource::kData;
  if (info.motion_compensated || profile.time_source != sensors::TimeSource::kData) {
    fields.time.reset();
  }
  return [fields, read = std::move(read), unit_m = statements->point_unit_m](const ScanFile& scan) {
    const PointCloud cloud = read(scan.file);
    return in_metres(scan_of_columns(columns_of(cloud), *scan.stamp, fields, scan.file), unit_m);
  };
}

}  // namespace traverse::dataset
