#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/geodesy/local_tangent_plane.hpp"

#include "folder_opening.hpp"
#include "listed_source.hpp"
#include "navigation_log.hpp"
#include "regular_clock.hpp"
#include "vehicle_statements.hpp"

namespace traverse::dataset {

using files::InputError;
using files::Place;
using geometry::Stamp;
using sensors::SensorKind;

namespace {

namespace fs = std::filesystem;

constexpr const char* kImu = "imu";
constexpr const char* kGnss = "gnss";
constexpr const char* kWheels = "wheels";

struct CsvRow {
  Stamp stamp;
  std::vector<double> values;
  std::string place;
};

/// The rows of the columns that are stated; those that cannot be used go to `records`.
std::vector<CsvRow> read_rows(const fs::path& file, const CsvColumns& stated, double time_unit_s,
                              std::vector<ListedRecord>& records) {
  files::LineReader reader(file);
  if (!reader.next()) throw reader.error("a header line", "an empty file");
  std::vector<std::string> header;
  for (const auto cell : files::split_cells(reader.line(), ',')) header.emplace_back(cell);
  const auto column_of = [&](std::string_view name) {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end()) {
      throw reader.error("a column " + files::in_quotes(name), reader.line());
    }
    return static_cast<std::size_t>(found - header.begin());
  };
  std::vector<std::size_t> columns{column_of(stated.time)};
  for (const auto name : files::split_words(stated.columns)) columns.push_back(column_of(name));

  std::vector<CsvRow> rows;
  while (reader.next()) {
    const std::string place = fmt::format("{}, line {}", file.filename().string(), reader.number());
    const auto cells = files::split_cells(reader.line(), ',');
    CsvRow row{{}, {}, place};
    std::string fault;
    if (cells.size() != header.size())
      fault = "CSV line with another number of cells than its header";
    for (std::size_t k = 0; k < columns.size() && fault.empty(); ++k) {
      const auto value = files::parse_double(cells[columns[k]]);
      if (!value || !std::isfinite(*value)) fault = "CSV line with a cell that is no finite number";
      if (fault.empty() && k == 0) row.stamp = Stamp::from_seconds(*value * time_unit_s);
      if (fault.empty() && k > 0) row.values.push_back(*value);
    }
    if (fault.empty()) {
      rows.push_back(std::move(row));
    } else {
      records.push_back({std::nullopt, fault, place});
    }
  }
  return rows;
}

/// What a folder's statements name, read.
class CsvRecording {
 public:
  CsvRecording(const fs::path& folder, const Statements& statements)
      : folder_(folder), statements_(statements), csv_(statements->csv) {}

  void read_imu() {
    if (csv_.gyro.file.empty() != csv_.accelerometer.file.empty()) {
      throw statements_.error("csv.gyro.file", "gyro and accelerometer, or neither", "one of them");
    }
    if (csv_.gyro.file.empty()) return;
    const double unit = csv_.angular_rate == AngularUnit::kDegrees ? std::numbers::pi / 180 : 1;
    const auto gyro = rows("csv.gyro", csv_.gyro, 3, 3);
    const auto accelerometer = rows("csv.accelerometer", csv_.accelerometer, 3, 3);
    std::size_t k = 0;
    for (const CsvRow& row : gyro) {
      while (k + 1 < accelerometer.size() && accelerometer[k + 1].stamp <= row.stamp) ++k;
      const auto force = interpolated(accelerometer, k, row.stamp);
      if (!force) {
        records.push_back({std::nullopt, "gyro without accelerometer within 50 ms", row.place});
        continue;
      }
      add(sensors::ImuSample{row.stamp, kImu, unit * vector_of(row), *force}, row.place);
    }
  }

  void read_gnss() {
    if (csv_.gnss.file.empty()) return;
    for (const CsvRow& row : rows("csv.gnss", csv_.gnss, 3, 4)) {
      if (std::abs(row.values[0]) > 90 || std::abs(row.values[1]) > 360) {
        records.push_back({std::nullopt, "GNSS line with no such place", row.place});
        continue;
      }
      sensors::GnssFix fix;
      fix.stamp = row.stamp;
      fix.sensor = kGnss;
      fix.latitude_deg = row.values[0];
      fix.longitude_deg = row.values[1];
      fix.altitude_m = row.values[2];
      if (row.values.size() > 3) fix.heading_deg = row.values[3];
      add(fix, row.place);
    }
  }

  void read_wheels() {
    if (csv_.wheels.file.empty()) return;
    for (const CsvRow& row : rows("csv.wheels", csv_.wheels, 1, 8)) {
      double sum = 0;
      for (const double speed : row.values) sum += speed;
      sensors::WheelOdometry reading;
      reading.stamp = row.stamp;
      reading.sensor = kWheels;
      reading.velocity = {sum / static_cast<double>(row.values.size()), 0, 0};
      add(reading, row.place);
    }
  }

  std::optional<Reference> read_reference() {
    if (csv_.reference.file.empty()) return std::nullopt;
    const auto poses = rows("csv.reference", csv_.reference, 7, 7);
    if (poses.empty()) return std::nullopt;
    Reference reference;
    reference.file = statements_.find_file("csv.reference.file", csv_.reference.file);
    reference.description = "earth-centred poses in the tangent plane at the first one";
    reference.north_map = Eigen::Vector3d::UnitY();
    const geodesy::LocalTangentPlane plane(geodesy::from_ecef(vector_of(poses.front())));
    const Eigen::Matrix3d R_body_axes = stated_rotation(
        statements_, "csv.reference.roll_pitch_yaw_deg", csv_.reference_roll_pitch_yaw_deg);
    for (const CsvRow& row : poses) {
      const Eigen::Quaterniond q(row.values[3], row.values[4], row.values[5], row.values[6]);
      if (q.norm() < 0.5) continue;
      const geometry::Pose3 pose{
          plane.R_enu_ecef() * q.normalized().toRotationMatrix() * R_body_axes.transpose(),
          plane.ecef_to_enu(vector_of(row))};
      const bool is_later =
          reference.T_map_body.empty() || reference.T_map_body.stamps().back() < row.stamp;
      if (is_later) reference.T_map_body.push_back(row.stamp, pose);
    }
    facts.push_back({"reference", reference.file.string(), reason("csv.reference.file")});
    facts.push_back({"reference frame", reference.description, reason("csv.reference.columns")});
    return reference;
  }

  std::string reason(const char* key) const { return statements_.reason(key, "default"); }

  std::vector<ListedRecord> records;
  std::vector<Fact> facts;

 private:
  std::vector<CsvRow> rows(const std::string& key, const CsvColumns& stated, std::size_t least,
                           std::size_t most) {
    const std::size_t count = files::split_words(stated.columns).size();
    if (count < least || count > most) {
      throw statements_.error(key + ".columns",
                              least == most ? fmt::format("{} names", least)
                                            : fmt::format("{} to {} names", least, most),
                              fmt::format("{}", count));
    }
    auto rows = read_rows(statements_.find_file(key + ".file", stated.file), stated,
                          csv_.time_unit_s, records);
    if (stated.period_s > 0) regularise(key, stated.period_s, rows);
    return rows;
  }

  void regularise(const std::string& key, double period_s, std::vector<CsvRow>& rows) {
    std::vector<Stamp> stamps;
    for (const CsvRow& row : rows) stamps.push_back(row.stamp);
    const auto fit = put_on_clock(stamps, period_s);
    const std::string why = statements_.reason(key + ".period_s", "default");
    if (!fit) {
      facts.push_back({key + ", stamps", "as they are: they do not keep the period", why});
      return;
    }
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k].stamp = stamps[k];
    facts.push_back(
        {key + ", stamps",
         fmt::format("put on a clock of {:.7f} s, moved by {:.1f} ms rms and {:.1f} ms "
                     "at most, {} ticks without a reading",
                     fit->period_s, 1e3 * fit->rms_moved_s, 1e3 * fit->most_moved_s, fit->missing),
         why});
  }

  static Eigen::Vector3d vector_of(const CsvRow& row) {
    return {row.values[0], row.values[1], row.values[2]};
  }

  /// Between the rows k and k + 1; nothing if they are too far from `stamp`.
  static std::optional<Eigen::Vector3d> interpolated(const std::vector<CsvRow>& rows, std::size_t k,
                                                     Stamp stamp) {
    constexpr double kFar = 0.05;
    if (rows.empty()) return std::nullopt;
    if (rows[k].stamp == stamp) return vector_of(rows[k]);
    const bool is_between = k + 1 < rows.size() && rows[k].stamp < stamp;
    const double span =
        is_between ? geometry::seconds_between(rows[k].stamp, rows[k + 1].stamp) : 0;
    if (is_between && span < kFar) {
      const double share = geometry::seconds_between(rows[k].stamp, stamp) / span;
      return Eigen::Vector3d((1 - share) * vector_of(rows[k]) + share * vector_of(rows[k + 1]));
    }
    if (std::abs(geometry::seconds_between(rows[k].stamp, stamp)) < kFar) return vector_of(rows[k]);
    return std::nullopt;
  }

  void add(sensors::Measurement measurement, const std::string& place) {
    records.push_back({std::move(measurement), "", place});
  }

  fs::path folder_;
  const Statements& statements_;
  const CsvStatements& csv_;
};

}  // namespace

std::unique_ptr<Source> open_csv_folder(const fs::path& folder, const OpenOptions& options) {
  const Statements statements(folder / "traverse.yaml", options, folder);
  RecordingInfo info = begin_info(folder, "CSV folder", statements, "vehicle");
  CsvRecording recording(folder, statements);
  recording.read_imu();
  recording.read_gnss();
  recording.read_wheels();
  const CsvStatements& csv = statements->csv;
  for (const auto& [label, kind, file] : {std::tuple{kImu, SensorKind::kImu, csv.gyro.file},
                                          {kGnss, SensorKind::kGnss, csv.gnss.file},
                                          {kWheels, SensorKind::kWheels, csv.wheels.file}}) {
    if (file.empty()) continue;
    info.rig.sensors.push_back({label, kind, geometry::Pose3::identity(), std::nullopt});
    apply_vehicle(statements, info.rig.sensors.back());
    info.facts.push_back({std::string(label) + " file", file,
                          recording.reason(kind == SensorKind::kImu    ? "csv.gyro.file"
                                           : kind == SensorKind::kGnss ? "csv.gnss.file"
                                                                       : "csv.wheels.file")});
  }
  if (info.rig.sensors.empty()) {
    throw InputError(folder, Place::key("csv"), "statements that tell what the CSV files hold",
                     "none; give a file with --recording-config, see share/recordings");
  }
  auto reference = recording.read_reference();
  info.facts.insert(info.facts.end(), recording.facts.begin(), recording.facts.end());
  if (const auto stated = stated_reference(statements); stated && !reference) {
    reference = load_reference(*stated, {}, {}, info.facts);
  }
  return make_listed_source(std::move(info), std::move(recording.records), std::move(reference));
}

}  // namespace traverse::dataset
