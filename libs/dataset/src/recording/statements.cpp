#include "recording/statements.hpp"

#include <array>
#include <utility>

#include "recording/lidars_as_one.hpp"

namespace traverse::dataset {

using config::Binder;
using config::Range;
using files::InputError;
using files::Place;

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kOption = "--recording";
constexpr std::array<std::pair<std::string_view, ReferenceFrame>, 3> kFrames{
    {{"body", ReferenceFrame::kBody},
     {"lidar", ReferenceFrame::kLidar},
     {"camera", ReferenceFrame::kCamera}}};

void bind_lidar(Binder& b, sensors::LidarProfile& profile, PointFieldStatements& points,
                std::string& topic, std::string& metadata) {
  b.group("lidar", "over the sensor profile, and the fields of its points", [&](Binder& lidar) {
    sensors::bind(lidar, profile);
    bind(lidar, points);
    lidar.text("topic", topic, "of a bag");
    lidar.text("metadata", metadata, "of an Ouster whose packets these are: its JSON file");
  });
}

}  // namespace

std::string_view name_of(ReferenceFrame frame) {
  for (const auto& [name, value] : kFrames) {
    if (value == frame) return name;
  }
  return "unknown";
}

void bind(Binder& b, StatedValues& v) {
  b.text("name", v.name, "name of the recording in reports");
  b.flag("motion_compensated", v.motion_compensated,
         "the points of a scan are already deskewed to its stamp");
  b.text("sensor", v.sensor, "lidar profile: a name in share/sensors, or a file");
  b.text("lidars", v.lidars, "labels of lidars whose scans are used as one's, commas between");
  b.text("lidars_late_s", v.lidars_late_s,
         "by how much the stamps of each but the first are late, commas between; else as found");
  b.group("reference", "reference trajectory", [&](Binder& reference) {
    reference.text("file", v.reference_file, "relative to the recording's folder");
    reference.choice("format", v.reference_format, kTrajectoryFormatNames, "of the file");
    reference.choice("frame", v.reference_frame, kFrames, "whose poses the file holds");
    reference.text("topic", v.topics.reference, "of a bag with the poses");
    reference.number("north_deg", v.reference_north_deg, Range::between(-360, 360),
                     "true north in the file's map, from x towards y");
  });
  b.text("calibration", v.calibration, "file in KITTI's form with the camera's pose");
  b.text("body_frame", v.body_frame, "name of the body frame in reports");
  b.number("period_s", v.period_s, Range::positive(), "between scans without stamps");
  b.text("first_stamp", v.first_stamp, "of the first scan without stamps, seconds");
  b.text("accept", v.accept, "codes of contradictions to go on with, blanks between");
  b.number("point_unit_m", v.point_unit_m, Range::positive(),
           "metres that a 1 in a point's coordinates means");
  b.number("point_time_unit_s", v.point_time_unit_s, Range::positive(),
           "seconds that a 1 in a point's time means; else by the time to the next scan");
  b.group("bin", "how a .bin file holds points", [&](Binder& bin) { bind(bin, v.bin); });
  b.group("imu", "what the numbers of an IMU mean", [&](Binder& imu) {
    bind(imu, v.imu);
    imu.text("topic", v.topics.imu, "of a bag");
  });
  b.group("gnss", "what the numbers of a fix mean", [&](Binder& gnss) {
    bind(gnss, v.gnss);
    gnss.text("topic", v.topics.gnss, "of a bag");
  });
  b.group("wheels", "wheel odometry", [&](Binder& wheels) {
    wheels.text("topic", v.topics.wheels, "of a bag");
    bind(wheels, v.wheel_joints);
  });
  b.group("laser", "2-D laser",
          [&](Binder& laser) { laser.text("topic", v.topics.laser, "of a bag"); });
  b.group("vehicle", "mounting of the sensors, and wheel odometry",
          [&](Binder& vehicle) { bind(vehicle, v.vehicle); });
  b.group("log", "format of a text log", [&](Binder& log) { bind(log, v.log); });
  b.group("csv", "files and columns of a CSV recording", [&](Binder& csv) { bind(csv, v.csv); });
}

Statements::Statements(const fs::path& sidecar, const OpenOptions& options, fs::path folder)
    : folder_(std::move(folder)), wants_reference_(options.wants_reference) {
  if (fs::exists(sidecar)) document_.overlay(config::Document::load(sidecar));
  if (options.statements_file) {
    document_.overlay(config::Document::load(*options.statements_file));
  }
  for (const std::string& statement : options.statements) {
    document_.set(with_list_as_text(statement), kOption);
  }

  sensors::LidarProfile checked_only;
  config::read(document_, [&](Binder& b) {
    bind(b, values_);
    bind_lidar(b, checked_only, values_.points, values_.topics.lidar, values_.lidar_metadata);
  });
}

void Statements::override_profile(sensors::LidarProfile& profile) const {
  StatedValues known;  // so that its keys are not taken for unknown ones
  config::read(document_, [&](Binder& b) {
    bind(b, known);
    bind_lidar(b, profile, known.points, known.topics.lidar, known.lidar_metadata);
  });
}

std::optional<std::string> Statements::origin(std::string_view key) const {
  auto origin = document_.origin(key);
  if (!origin) return std::nullopt;
  const fs::path source = origin->source;
  if (origin->line > 0 && source.parent_path() == folder_) {
    origin->source = source.filename().string();
  }
  return to_text(*origin);
}

std::string Statements::reason(std::string_view key, std::string otherwise) const {
  return origin(key).value_or(std::move(otherwise));
}

fs::path Statements::find_file(std::string_view key, const std::string& value) const {
  const auto origin = document_.origin(key);
  const bool on_command_line = !origin || origin->line == 0;
  const fs::path stated_in = on_command_line ? fs::path() : fs::path(origin->source).parent_path();
  for (const fs::path& folder : {folder_, stated_in}) {
    if (fs::path file = folder / value; fs::is_regular_file(file)) return file;
  }
  throw error(key, "a file, relative to " + folder_.string(), files::in_quotes(value));
}

InputError Statements::error(std::string_view key, std::string expected, std::string found) const {
  const config::Origin origin = document_.origin(key).value_or(config::Origin{});
  return {origin.source, origin.line == 0 ? Place::whole_file() : Place::line(origin.line),
          std::move(expected) + " for '" + std::string(key) + "'", std::move(found)};
}

}  // namespace traverse::dataset
