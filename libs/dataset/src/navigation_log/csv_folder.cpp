#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/geodesy/local_tangent_plane.hpp"

#include "kitti/regular_clock.hpp"
#include "navigation_log/navigation_log.hpp"
#include "recording/folder_opening.hpp"
#include "recording/listed_source.hpp"
#include "recording/unused_files.hpp"
#include "recording/vehicle_statements.hpp"

namespace traverse::dataset {

using files::InputError;
using files::Place;
using geometry::Stamp;
using sensors::SensorKind;

namespace {

namespace fs = std::filesystem;

constexpr const char* kImuTable = "imu";
constexpr const char* kFixTable = "gnss";
constexpr const char* kWheelTable = "wheels";

/// The rows that can be used, side by side: one allocation a row would outweigh its numbers.
class CsvRows {
 public:
  CsvRows(std::string file, std::size_t columns) : file_(std::move(file)), columns_(columns) {}

  void add(Stamp stamp, std::span<const double> values, std::size_t line) {
    stamps_.push_back(stamp);
    values_.insert(values_.end(), values.begin(), values.end());
    lines_.push_back(line);
  }
  std::size_t size() const { return stamps_.size(); }
  bool empty() const { return stamps_.empty(); }
  std::vector<Stamp>& stamps() { return stamps_; }
  Stamp stamp(std::size_t i) const { return stamps_[i]; }
  std::span<const double> values(std::size_t i) const {
    return std::span(values_).subspan(i * columns_, columns_);
  }
  Eigen::Vector3d vector(std::size_t i) const {
    const auto row = values(i);
    return {row[0], row[1], row[2]};
  }
  std::string place(std::size_t i) const { return place_of_line(lines_[i]); }
  std::string place_of_line(std::size_t line) const {
    return fmt::format("{}, line {}", file_, line);
  }

 private:
  std::string file_;
  std::size_t columns_;
  std::vector<Stamp> stamps_;
  std::vector<double> values_;  ///< row after row
  std::vector<std::size_t> lines_;
};

/// The rows of the columns that are stated; those that cannot be used go to `records`.
CsvRows read_rows(const fs::path& file, const CsvColumns& stated, double time_unit_s,
                  ListedRecords& records) {
  constexpr double kLatest = 9e9;  // seconds that whole nanoseconds can hold
  files::LineReader reader(file);
  if (!reader.next()) throw reader.error("a header line", "an empty file");
  std::vector<std::string> header;
  for (const auto cell : files::split_cells(reader.line(), ',')) header.emplace_back(cell);
  const auto column_of = [&](std::string_view name) {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end()) {
      constexpr std::size_t kShown = 500;
      throw reader.error("a column " + files::in_quotes(name), reader.line().substr(0, kShown));
    }
    return static_cast<std::size_t>(found - header.begin());
  };
  std::vector<std::size_t> columns{column_of(stated.time)};
  for (const auto name : files::split_words(stated.columns)) columns.push_back(column_of(name));

  CsvRows rows(file.filename().string(), columns.size() - 1);
  std::vector<double> values;
  while (reader.next()) {
    const auto cells = files::split_cells(reader.line(), ',');
    std::string fault;
    Stamp stamp;
    values.clear();
    if (cells.size() != header.size())
      fault = "CSV line with another number of cells than its header";
    for (std::size_t k = 0; k < columns.size() && fault.empty(); ++k) {
      const auto value = files::parse_double(cells[columns[k]]);
      if (!value || !std::isfinite(*value)) fault = "CSV line with a cell that is no finite number";
      if (fault.empty() && k == 0) {
        const double seconds = *value * time_unit_s;
        if (!(std::abs(seconds) <= kLatest)) fault = "CSV line with no such time";
        stamp = Stamp::from_seconds(seconds);
      }
      if (fault.empty() && k > 0) values.push_back(*value);
    }
    if (fault.empty()) {
      rows.add(stamp, values, reader.number());
    } else {
      records.skip(fault, rows.place_of_line(reader.number()));
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
    for (std::size_t i = 0; i < gyro.size(); ++i) {
      const Stamp stamp = gyro.stamp(i);
      while (k + 1 < accelerometer.size() && accelerometer.stamp(k + 1) <= stamp) ++k;
      const auto force = interpolated(accelerometer, k, stamp);
      if (!force) {
        records.skip("gyro without accelerometer within 50 ms", gyro.place(i));
        continue;
      }
      records.add(sensors::ImuSample{stamp, kImuTable, unit * gyro.vector(i), *force},
                  gyro.place(i));
    }
  }

  void read_gnss() {
    if (csv_.gnss.file.empty()) return;
    const auto fixes = rows("csv.gnss", csv_.gnss, 3, 4);
    for (std::size_t i = 0; i < fixes.size(); ++i) {
      const auto values = fixes.values(i);
      if (std::abs(values[0]) > 90 || std::abs(values[1]) > 360) {
        records.skip("GNSS line with no such place", fixes.place(i));
        continue;
      }
      sensors::GnssFix fix;
      fix.stamp = fixes.stamp(i);
      fix.sensor = kFixTable;
      fix.latitude_deg = values[0];
      fix.longitude_deg = values[1];
      fix.altitude_m = values[2];
      if (values.size() > 3) fix.heading_deg = values[3];
      records.add(fix, fixes.place(i));
    }
  }

  void read_wheels() {
    if (csv_.wheels.file.empty()) return;
    const auto speeds = rows("csv.wheels", csv_.wheels, 1, 8);
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      const auto values = speeds.values(i);
      double sum = 0;
      for (const double speed : values) sum += speed;
      sensors::WheelOdometry reading;
      reading.stamp = speeds.stamp(i);
      reading.sensor = kWheelTable;
      reading.velocity = {sum / static_cast<double>(values.size()), 0, 0};
      records.add(reading, speeds.place(i));
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
    const geodesy::LocalTangentPlane plane(geodesy::from_ecef(poses.vector(0)));
    const Eigen::Matrix3d R_body_axes = stated_rotation(
        statements_, "csv.reference.roll_pitch_yaw_deg", csv_.reference_roll_pitch_yaw_deg);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const auto values = poses.values(i);
      const Eigen::Quaterniond q(values[3], values[4], values[5], values[6]);
      if (q.norm() < 0.5) continue;
      const geometry::Pose3 pose{
          plane.R_enu_ecef() * q.normalized().toRotationMatrix() * R_body_axes.transpose(),
          plane.ecef_to_enu(poses.vector(i))};
      const bool is_later =
          reference.T_map_body.empty() || reference.T_map_body.stamps().back() < poses.stamp(i);
      if (is_later) reference.T_map_body.push_back(poses.stamp(i), pose);
    }
    facts.push_back({"reference", reference.file.string(), reason("csv.reference.file")});
    facts.push_back({"reference frame", reference.description, reason("csv.reference.columns")});
    return reference;
  }

  std::string reason(const char* key) const { return statements_.reason(key, "default"); }

  ListedRecords records;
  std::vector<Fact> facts;

 private:
  CsvRows rows(const std::string& key, const CsvColumns& stated, std::size_t least,
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

  void regularise(const std::string& key, double period_s, CsvRows& rows) {
    const auto fit = put_on_clock(rows.stamps(), period_s);
    const std::string why = statements_.reason(key + ".period_s", "default");
    if (!fit) {
      facts.push_back({key + ", stamps", "as they are: they do not keep the period", why});
      return;
    }
    facts.push_back(
        {key + ", stamps",
         fmt::format("put on a clock of {:.7f} s, moved by {:.1f} ms rms and {:.1f} ms "
                     "at most, {} ticks without a reading",
                     fit->period_s, 1e3 * fit->rms_moved_s, 1e3 * fit->max_moved_s, fit->missing),
         why});
  }

  /// Between the rows k and k + 1; nothing if they are too far from `stamp`.
  static std::optional<Eigen::Vector3d> interpolated(const CsvRows& rows, std::size_t k,
                                                     Stamp stamp) {
    constexpr double kFar = 0.05;
    if (rows.empty()) return std::nullopt;
    const Stamp before = rows.stamp(k);
    if (before == stamp) return rows.vector(k);
    const bool is_between = k + 1 < rows.size() && before < stamp;
    const double span = is_between ? geometry::seconds_between(before, rows.stamp(k + 1)) : 0;
    if (is_between && span < kFar) {
      const double share = geometry::seconds_between(before, stamp) / span;
      return Eigen::Vector3d((1 - share) * rows.vector(k) + share * rows.vector(k + 1));
    }
    if (std::abs(geometry::seconds_between(before, stamp)) < kFar) return rows.vector(k);
    return std::nullopt;
  }

  fs::path folder_;
  const Statements& statements_;
  const CsvStatements& csv_;
};

std::string how_to_state(const fs::path& folder, const fs::path& share_folder) {
  const auto fitting = fitting_statements(folder, share_folder);
  if (fitting.empty()) return "give a file with --recording-config, see share/recordings";
  return fmt::format("{} fits these files: --recording-config {}",
                     fitting.front().filename().string(), fitting.front().string());
}

}  // namespace

std::unique_ptr<Source> open_csv_folder(const fs::path& folder, const OpenOptions& options,
                                        std::string_view format) {
  const Statements statements(folder / "traverse.yaml", options, folder);
  RecordingInfo info = begin_info(folder, format, statements, "vehicle");
  CsvRecording recording(folder, statements);
  recording.read_imu();
  recording.read_gnss();
  recording.read_wheels();
  const CsvStatements& csv = statements->csv;
  for (const auto& [label, kind, file] : {std::tuple{kImuTable, SensorKind::kImu, csv.gyro.file},
                                          {kFixTable, SensorKind::kGnss, csv.gnss.file},
                                          {kWheelTable, SensorKind::kWheels, csv.wheels.file}}) {
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
                     "none; " + how_to_state(folder, options.share_folder));
  }
  auto reference = recording.read_reference();
  info.facts.insert(info.facts.end(), recording.facts.begin(), recording.facts.end());
  if (const auto stated = stated_reference(statements); stated && !reference) {
    reference = load_reference(*stated, {}, {}, info.facts);
  }
  note_unused_files(info, options, reference, 0);
  return make_listed_source(std::move(info), std::move(recording.records), std::move(reference));
}

}  // namespace traverse::dataset
