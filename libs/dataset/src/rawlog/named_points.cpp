#include "rawlog/named_points.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "traverse/files/input_error.hpp"
#include "traverse/mrpt_io/mrpt_values.hpp"
#include "traverse/statistics/quantile.hpp"

#include "point_clouds/point_columns.hpp"
#include "point_clouds/point_statements.hpp"

namespace traverse::dataset {

using geometry::Stamp;
using mrpt::obs::CObservationPointCloud;
using sensors::LidarScan;

namespace {

constexpr std::size_t kExampleClouds = 5;
/// How far the examples may stand apart.
constexpr std::size_t kExampleRecords = 2000;
constexpr std::uint64_t kExampleBytes = 64 << 20;

template <typename Number>
constexpr ScalarType scalar_type() {
  if constexpr (std::is_same_v<Number, float>) return ScalarType::kFloat;
  if constexpr (std::is_same_v<Number, double>) return ScalarType::kDouble;
  if constexpr (std::is_same_v<Number, std::uint8_t>) return ScalarType::kUint8;
  if constexpr (std::is_same_v<Number, std::uint16_t>) return ScalarType::kUint16;
  return ScalarType::kUint32;
}

template <typename Number>
PointColumn column_over(const std::string& name, const std::vector<Number>& values) {
  PointColumn column;
  column.name = name;
  column.type = scalar_type<Number>();
  column.first = reinterpret_cast<const std::byte*>(values.data());
  column.stride = sizeof(Number);
  return column;
}

/// Refers to both.
PointColumns columns_over(const LidarScan& scan, const std::vector<mrpt_io::NamedField>& fields) {
  PointColumns points;
  points.points = scan.size();
  points.columns = {column_over("x", scan.x), column_over("y", scan.y), column_over("z", scan.z)};
  for (const mrpt_io::NamedField& field : fields) {
    std::visit(
        [&](const auto& values) { points.columns.push_back(column_over(field.name, values)); },
        field.values);
  }
  return points;
}

/// A cloud that shows what those of a lidar hold; the fields are the observation's.
struct ExampleCloud {
  CObservationPointCloud::Ptr observation;
  LidarScan scan;
  Stamp stamp;
};

void take_example(const mrpt::obs::CObservation::Ptr& observation, const std::string& lidar,
                  const std::string& external_folder, std::deque<ExampleCloud>& examples) {
  const auto cloud = std::dynamic_pointer_cast<CObservationPointCloud>(observation);
  if (cloud == nullptr || cloud->sensorLabel != lidar) return;
  const auto stamp = mrpt_io::to_stamp(cloud->timestamp);
  if (!stamp) return;
  try {
    LidarScan scan = mrpt_io::take_scan(*cloud, external_folder);
    if (mrpt_io::named_fields(*cloud) == nullptr || scan.empty()) return;
    examples.push_back({cloud, std::move(scan), *stamp});
  } catch (const mrpt_io::UnusableObservation&) {
    return;  // counted when the recording is read
  }
}

/// The first clouds of a lidar from the record of its first on.
std::deque<ExampleCloud> first_clouds(const std::filesystem::path& rawlog,
                                      const std::string& external_folder, const std::string& lidar,
                                      const mrpt_io::RawlogRecord& first) {
  std::deque<ExampleCloud> examples;
  mrpt_io::RawlogReader reader(rawlog);
  reader.return_to({first.begin, first.number, std::nullopt});
  while (examples.size() < kExampleClouds &&
         reader.records_read() < first.number + kExampleRecords &&
         reader.bytes_read() < first.begin + kExampleBytes) {
    const auto record = reader.next();
    if (!record) break;
    if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(record->object)) {
      for (const auto& observation : *frame) {
        take_example(observation, lidar, external_folder, examples);
      }
    } else {
      take_example(std::dynamic_pointer_cast<mrpt::obs::CObservation>(record->object), lidar,
                   external_folder, examples);
    }
  }
  return examples;
}

}  // namespace

NamedPoints::NamedPoints(std::filesystem::path rawlog, std::string external_folder,
                         const Statements& statements, RecordingInfo& info)
    : rawlog_(std::move(rawlog)),
      external_folder_(std::move(external_folder)),
      statements_(statements),
      info_(info) {}

const PointFields& NamedPoints::fields_of(const std::string& lidar,
                                          const mrpt_io::RawlogRecord& record) {
  const auto known = known_.find(lidar);
  if (known != known_.end()) return known->second;
  const auto examples = first_clouds(rawlog_, external_folder_, lidar, record);
  std::vector<PointSample> samples;
  std::vector<PointSample> with_one_time;
  std::vector<double> intervals;
  for (std::size_t i = 0; i < examples.size(); ++i) {
    const ExampleCloud& example = examples[i];
    if (i > 0) {
      intervals.push_back(geometry::seconds_between(examples[i - 1].stamp, example.stamp));
    }
    PointSample sample{columns_over(example.scan, *mrpt_io::named_fields(*example.observation)),
                       example.stamp};
    (has_one_time(sample.points) ? with_one_time : samples).push_back(std::move(sample));
  }
  if (samples.empty()) samples = std::move(with_one_time);
  PointFieldHints hints = stated_point_fields(statements_);
  const double interval = intervals.empty() ? 0 : statistics::median(intervals);
  if (interval > 0) hints.scan_interval_s = interval;
  hints.recording = rawlog_;
  std::vector<Fact> facts;
  PointFields fields = interpret_points(samples, hints, facts);
  fields.needs_rings = false;
  if (info_.motion_compensated) fields.time.reset();  // points that are moved need none
  const bool is_first = info_.rig.first(sensors::SensorKind::kLidar) == nullptr;
  for (Fact& fact : facts) {
    if (!is_first) fact.name = lidar + ": " + fact.name;
    info_.facts.push_back(std::move(fact));
  }
  return known_.emplace(lidar, std::move(fields)).first->second;
}

LidarScan NamedPoints::interpret(const std::vector<mrpt_io::NamedField>& fields, LidarScan scan,
                                 Stamp stamp, const std::string& lidar,
                                 const mrpt_io::RawlogRecord& record) {
  const PointFields& known = fields_of(lidar, record);
  try {
    return scan_of_columns(columns_over(scan, fields), stamp, known, rawlog_);
  } catch (const files::InputError& error) {  // of a cloud whose fields are others than before
    throw mrpt_io::UnusableObservation(
        fmt::format("expected {}, found {}", error.expected(), error.found()));
  }
}

}  // namespace traverse::dataset
