#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "traverse/config/document.hpp"
#include "traverse/dataset/open_recording.hpp"
#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/sensors/lidar_profile.hpp"

#include "bags/wheel_joint_statements.hpp"
#include "navigation_log/log_statements.hpp"
#include "point_clouds/bin_points.hpp"
#include "point_clouds/point_statements.hpp"
#include "recording/measurement_statements.hpp"
#include "recording/vehicle_statements.hpp"

namespace traverse::dataset {

/// The frame whose poses a reference file holds.
enum class ReferenceFrame { kBody, kLidar, kCamera };

std::string_view name_of(ReferenceFrame frame);

/// The topics of a bag that are taken, where they are stated.
struct TopicStatements {
  std::string lidar;
  std::string imu;
  std::string gnss;
  std::string wheels;
  std::string laser;  ///< a 2-D one
  std::string reference;
};

/// What can be stated about a recording, with what holds if it is not.
struct StatedValues {
  std::string name;
  bool motion_compensated = false;
  std::string sensor;
  std::string lidars;         ///< labels, commas between
  std::string lidars_late_s;  ///< of all but the first, commas between
  std::string lidar_metadata;
  std::string reference_file;
  TrajectoryFormat reference_format = TrajectoryFormat::kAuto;
  ReferenceFrame reference_frame = ReferenceFrame::kBody;
  double reference_north_deg = 0;  ///< holds when it is stated
  std::string calibration;
  std::string body_frame;
  double period_s = 0.1;
  std::string first_stamp;
  std::string accept;
  double point_unit_m = 1;
  double point_time_unit_s = 1;  ///< holds when it is stated
  PointFieldStatements points;
  BinStatements bin;
  VehicleStatements vehicle;
  ImuStatements imu;
  GnssStatements gnss;
  LogStatements log;
  CsvStatements csv;
  TopicStatements topics;
  WheelJointStatements wheel_joints;
};

void bind(config::Binder& binder, StatedValues& values);

/// What traverse.yaml, a file of statements and the command line say about a recording, the later
/// over the earlier, and where each of it stands.
class Statements {
 public:
  /// `sidecar` need not exist; `folder` is where relative paths begin.
  /// \throws files::InputError naming file and line, also for a key that is not known.
  Statements(const std::filesystem::path& sidecar, const OpenOptions& options,
             std::filesystem::path folder);

  bool want_reference() const { return wants_reference_; }
  const StatedValues* operator->() const { return &values_; }
  bool states(std::string_view key) const { return document_.origin(key).has_value(); }

  /// Where `key` stands, for a Fact: "traverse.yaml, line 3"; nothing if it is not stated.
  std::optional<std::string> origin(std::string_view key) const;
  /// The same, or `otherwise`.
  std::string reason(std::string_view key, std::string otherwise) const;

  /// Gives `profile` what stands under `lidar`. \throws files::InputError
  void override_profile(sensors::LidarProfile& profile) const;

  /// The file that `value`, stated by `key`, names: beside the recording, else beside the file that
  /// states it, or in the current folder for the command line. \throws files::InputError
  std::filesystem::path find_file(std::string_view key, const std::string& value) const;

  /// An error about the value of a stated key, to be thrown.
  files::InputError error(std::string_view key, std::string expected, std::string found) const;

 private:
  config::Document document_;
  StatedValues values_;
  std::filesystem::path folder_;
  bool wants_reference_;
};

}  // namespace traverse::dataset
