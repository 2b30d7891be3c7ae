#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/geodesy/local_tangent_plane.hpp"

#include "kitti/regular_clock.hpp"
#include "navigation_log/csv_rows.hpp"
#include "navigation_log/known_columns.hpp"
#include "navigation_log/navigation_log.hpp"
#include "navigation_log/tables_beside.hpp"
#include "recording/folder_opening.hpp"
#include "recording/listed_source.hpp"
#include "recording/note_once.hpp"
#include "recording/stamp_sequence.hpp"
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

bool is_empty(const CsvStatements& csv) {
  return csv.gyro.file.empty() && csv.accelerometer.file.empty() && csv.gnss.file.empty() &&
         csv.wheels.file.empty();
}

/// What a folder's statements name, read.
class CsvRecording {
 public:
  CsvRecording(const fs::path& folder, const Statements& statements)
      : statements_(statements), csv_(statements->csv), stated_(statements->imu, statements->gnss) {
    if (is_empty(csv_)) {
      const KnownTables known = known_tables(folder);
      csv_.gyro = known.csv.gyro;
      csv_.accelerometer = known.csv.accelerometer;
      csv_.gnss = known.csv.gnss;
      csv_.wheels = known.csv.wheels;
      not_understood_ = known.not_understood;
      reason_unstated_ = "by the names of its columns";
    }
    if (csv_.gyro.file.empty() != csv_.accelerometer.file.empty()) {
      throw statements_.error("csv.gyro.file", "gyro and accelerometer, or neither", "one of them");
    }
    read_rows("csv.gyro", csv_.gyro, 3, 3, gyro_);
    read_rows("csv.accelerometer", csv_.accelerometer, 3, 3, accelerometer_);
    read_rows("csv.gnss", csv_.gnss, 3, 4, gnss_);
    read_rows("csv.wheels", csv_.wheels, 1, 8, wheels_);
    read_rows("csv.reference", csv_.reference, 7, 7, reference_);
    settle();
  }

  const CsvStatements& statements() const { return csv_; }

  void make_imu() {
    if (!gyro_ || !accelerometer_) return;
    const double unit = angular_unit();
    std::size_t k = 0;
    for (std::size_t i = 0; i < gyro_->size(); ++i) {
      const Stamp stamp = gyro_->stamp(i);
      while (k + 1 < accelerometer_->size() && accelerometer_->stamp(k + 1) <= stamp) ++k;
      const auto force = interpolated(*accelerometer_, k, stamp);
      if (!force) {
        records.skip("gyro without accelerometer within 50 ms", gyro_->place(i));
        continue;
      }
      sensors::ImuSample sample{stamp, kImuTable, unit * gyro_->vector(i), *force};
      if (stated_.apply(sample)) {
        records.add(sample, gyro_->line(i));
      } else {
        records.skip("IMU reading of increments with none before it", gyro_->place(i));
      }
    }
  }

  void make_gnss() {
    if (!gnss_) return;
    const CsvRows& fixes = *gnss_;
    for (std::size_t i = 0; i < fixes.size(); ++i) {
      const auto values = fixes.values(i);
      sensors::GnssFix fix;
      fix.stamp = fixes.stamp(i);
      fix.sensor = kFixTable;
      fix.latitude_deg = values[0];
      fix.longitude_deg = values[1];
      fix.altitude_m = values[2];
      if (values.size() > 3) fix.heading_deg = values[3];
      stated_.apply(fix);
      if (std::abs(fix.latitude_deg) > 90 || std::abs(fix.longitude_deg) > 360) {
        records.skip("GNSS line with no such place", fixes.place(i));
      } else if (is_nowhere(fix)) {
        records.skip(kNoFixYet, fixes.place(i));
      } else {
        records.add(fix, fixes.line(i));
      }
    }
  }

  void make_wheels() {
    if (!wheels_) return;
    const CsvRows& speeds = *wheels_;
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      const auto values = speeds.values(i);
      double sum = 0;
      for (const double speed : values) sum += speed;
      sensors::WheelOdometry reading;
      reading.stamp = speeds.stamp(i);
      reading.sensor = kWheelTable;
      reading.velocity = {sum / static_cast<double>(values.size()), 0, 0};
      records.add(reading, speeds.line(i));
    }
  }

  std::optional<Reference> make_reference() {
    if (!reference_ || reference_->empty()) return std::nullopt;
    const CsvRows& poses = *reference_;
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
      reference.T_map_body.push_back(poses.stamp(i), pose);
    }
    facts.push_back({"reference", reference.file.string(), reason("csv.reference.file")});
    facts.push_back({"reference frame", reference.description, reason("csv.reference.columns")});
    return reference;
  }

  /// A table whose name is known and whose columns are not; empty: none.
  const std::string& not_understood() const { return not_understood_; }

  std::string reason(const char* key) const { return statements_.reason(key, reason_unstated_); }

  ListedRecords records{ListedRecords::Stamps::kSettled};
  std::vector<Fact> facts;

 private:
  void read_rows(const std::string& key, const CsvColumns& stated, std::size_t least,
                 std::size_t most, std::optional<CsvRows>& rows) {
    if (stated.file.empty()) return;
    const std::size_t count = listed_columns(stated.columns).size();
    if (count < least || count > most) {
      throw statements_.error(key + ".columns",
                              least == most ? fmt::format("{} names", least)
                                            : fmt::format("{} to {} names", least, most),
                              fmt::format("{}", count));
    }
    std::optional<double> time_unit_s;
    if (statements_.states("csv.time_unit_s")) time_unit_s = csv_.time_unit_s;
    std::vector<Fact> told;
    rows = read_csv_rows(statements_.find_file(key + ".file", stated.file), stated, time_unit_s,
                         records, told);
    add_new(std::move(told));
  }

  /// Facts that another stream of the same file has not told already.
  void add_new(std::vector<Fact> told) {
    for (Fact& fact : told) note_once(std::move(fact), facts);
  }

  /// Makes the stamps of each file grow, and puts them on their sensor's clock where that is
  /// stated.
  void settle() {
    struct Stream {
      std::string key;
      const CsvColumns& stated;
      CsvRows* rows;
    };
    std::vector<Stream> streams;
    const auto add = [&](const char* key, const CsvColumns& stated, std::optional<CsvRows>& rows) {
      if (rows) streams.push_back({key, stated, &*rows});
    };
    add("csv.gyro", csv_.gyro, gyro_);
    add("csv.accelerometer", csv_.accelerometer, accelerometer_);
    add("csv.gnss", csv_.gnss, gnss_);
    add("csv.wheels", csv_.wheels, wheels_);
    add("csv.reference", csv_.reference, reference_);
    std::vector<SensorStamps> sensors;
    for (const Stream& stream : streams) {
      const std::vector<std::optional<Stamp>> stamps(stream.rows->stamps().begin(),
                                                     stream.rows->stamps().end());
      sensors.push_back({stream.stated.file, StampSequence::of(stamps),
                         [rows = stream.rows](std::size_t row) { return rows->place(row); }});
    }
    std::vector<Fact> steps;
    settle_steps(sensors, steps);
    add_new(std::move(steps));
    std::set<std::string> told;  // one file may hold several streams
    for (std::size_t i = 0; i < streams.size(); ++i) {
      streams[i].rows->take_stamps(sensors[i].sequence.records,
                                   [&](const char* fault, const std::string& place) {
                                     if (told.insert(place).second) records.skip(fault, place);
                                   });
      const double period_s = streams[i].stated.period_s;
      if (period_s > 0) regularise(streams[i].key, period_s, *streams[i].rows);
    }
  }

  /// Radians that a 1 in the gyro's columns means.
  double angular_unit() {
    constexpr double kDegrees = std::numbers::pi / 180;
    if (statements_.states("csv.angular_rate")) {
      return csv_.angular_rate == AngularUnit::kDegrees ? kDegrees : 1;
    }
    const CsvColumn& column = gyro_->columns().front();
    if (!column.unit.starts_with("deg")) return 1;
    facts.push_back({"angular rates", "deg/s",
                     fmt::format("the header's '{} [{}]'", column.name, column.unit)});
    return kDegrees;
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

  const Statements& statements_;
  CsvStatements csv_;
  StatedMeasurements stated_;
  std::string reason_unstated_ = "default";
  std::string not_understood_;
  std::optional<CsvRows> gyro_;
  std::optional<CsvRows> accelerometer_;
  std::optional<CsvRows> gnss_;
  std::optional<CsvRows> wheels_;
  std::optional<CsvRows> reference_;
};

/// The sensors of the tables, with the facts about them.
void mount_tables(CsvRecording& recording, const Statements& statements, RecordingInfo& info) {
  recording.make_imu();
  recording.make_gnss();
  recording.make_wheels();
  const CsvStatements& csv = recording.statements();
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
}

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
  mount_tables(recording, statements, info);
  if (info.rig.sensors.empty()) {
    throw InputError(folder, Place::key("csv"), "statements that tell what the CSV files hold",
                     (recording.not_understood().empty()
                          ? "none; "
                          : fmt::format("none, and the columns of {} are called as no sensor's; ",
                                        recording.not_understood())) +
                         how_to_state(folder, options.share_folder));
  }
  auto reference = recording.make_reference();
  info.facts.insert(info.facts.end(), recording.facts.begin(), recording.facts.end());
  if (const auto stated = stated_reference(statements); stated && !reference) {
    reference = load_reference(*stated, {}, {}, info.facts);
  }
  note_unused_files(info, options, reference, 0);
  return make_listed_source(std::move(info), std::move(recording.records), std::move(reference));
}

void add_tables(FolderRecording& recording, const fs::path& folder, const Statements& statements) {
  RecordingInfo& info = recording.info;
  CsvRecording tables(folder, statements);
  mount_tables(tables, statements, info);
  if (!tables.not_understood().empty()) {
    info.facts.push_back(
        {kNotUsed, tables.not_understood(),
         "its columns are called as no sensor's: state them, csv.gyro.columns and so on"});
  }
  auto reference = tables.make_reference();
  info.facts.insert(info.facts.end(), tables.facts.begin(), tables.facts.end());
  if (!recording.reference) recording.reference = std::move(reference);
  take_records(recording, std::move(tables.records));
}

}  // namespace traverse::dataset
