#include "recording/folder_opening.hpp"

#include <utility>

#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"

#include "recording/lidars_as_one.hpp"

namespace traverse::dataset {

using files::InputError;

namespace {

namespace fs = std::filesystem;

constexpr const char* kDefault = "default, not stated";
constexpr const char* kCalibration = "calibration";
constexpr const char* kNone = "none";

}  // namespace

RecordingInfo begin_info(const fs::path& path, std::string_view format,
                         const Statements& statements, const std::string& body_frame) {
  RecordingInfo info;
  info.path = path;
  info.format = format;
  const fs::path own_name = fs::is_directory(path) ? fs::canonical(path).filename() : path.stem();
  info.name = statements.states("name") ? statements->name : own_name.string();
  info.rig.body_frame = statements.states("body_frame") ? statements->body_frame : body_frame;
  info.facts.push_back(
      {"body frame", info.rig.body_frame, statements.reason("body_frame", kDefault)});
  add_measurement_facts(statements, info.facts);
  if (statements.states("lidars")) {
    info.facts.push_back({kLidarsAsOne, statements->lidars, *statements.origin("lidars")});
  }
  if (statements.states("lidars_late_s")) {
    info.facts.push_back(
        {kLidarsLate, statements->lidars_late_s, *statements.origin("lidars_late_s")});
  }
  for (const std::string_view code : files::split_words(statements->accept)) {
    info.accepted_contradictions.emplace_back(code);
  }
  return info;
}

void mount_lidar(RecordingInfo& info, const std::string& label, const ProfileChoice& choice,
                 const Statements& statements) {
  info.rig.sensors.push_back(
      {label, sensors::SensorKind::kLidar, geometry::Pose3::identity(), choice.profile});
  add_profile_facts(choice, statements, "", info.facts);
}

void set_motion_compensation(RecordingInfo& info, const Statements& statements, bool otherwise,
                             const std::string& why) {
  info.motion_compensated =
      statements.states("motion_compensated") ? statements->motion_compensated : otherwise;
  info.facts.push_back({"motion compensated", info.motion_compensated ? "yes" : "no",
                        statements.reason("motion_compensated", why)});
}

sensors::LidarScan in_metres(sensors::LidarScan scan, double unit_m) {
  if (unit_m == 1) return scan;
  for (auto* values : {&scan.x, &scan.y, &scan.z}) {
    for (float& value : *values) value = static_cast<float>(unit_m * value);
  }
  return scan;
}

void set_camera(RecordingInfo& info, const Statements& statements, const fs::path& otherwise) {
  const bool stated = statements.states("calibration");
  const fs::path file =
      stated ? statements.find_file("calibration", statements->calibration) : otherwise;
  if (!stated && !fs::exists(file)) return;
  try {
    const CameraCalibration calibration = read_camera_calibration(file);
    info.T_body_camera = calibration.T_camera_lidar.inverse();
    info.facts.push_back({kCalibration, "camera 0 from " + calibration.how + " of " + file.string(),
                          statements.reason("calibration", "found beside the scans")});
  } catch (const InputError& error) {
    if (stated) throw;
    info.facts.push_back({kCalibration, kNone, error.what()});
  }
}

std::optional<Reference> choose_reference(RecordingInfo& info, const Statements& statements,
                                          const std::optional<ReferenceFile>& found,
                                          const PoseStamps& stamps) {
  const ReferenceFrames frames{geometry::Pose3::identity(), info.T_body_camera};
  if (const auto stated = stated_reference(statements)) {
    return load_reference(*stated, frames, stamps, info.facts);
  }
  if (!found) return std::nullopt;
  try {
    return load_reference(*found, frames, stamps, info.facts);
  } catch (const InputError& error) {
    info.reference_refused = error.what();
    for (const Fact& fact : info.facts) {  // perhaps that is why
      if (fact.name == kCalibration && fact.value == kNone) {
        info.reference_refused += "; " + fact.reason;
      }
    }
    info.facts.push_back({"reference", kNone, info.reference_refused});
    return std::nullopt;
  }
}

}  // namespace traverse::dataset
