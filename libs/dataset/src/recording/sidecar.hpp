#pragma once

#include <optional>
#include <string>

#include "traverse/dataset/source.hpp"
#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/rig.hpp"

#include "navigation_log/log_statements.hpp"
#include "recording/vehicle_statements.hpp"

namespace traverse::dataset {

/// What is written beside a converted recording, so that opening it again tells the same.
struct Sidecar {
  std::string name;
  bool motion_compensated = false;
  std::string body_frame;
  std::optional<sensors::LidarProfile> profile;   ///< of the data as they are in the copy
  std::optional<geometry::Trajectory> reference;  ///< T_map_body of the copy's body
  std::optional<geometry::Pose3> T_camera_lidar;
  std::optional<Eigen::Vector3d> north_map;      ///< in the map of the reference
  std::optional<VehicleStatements> vehicle;      ///< of a copy that has no place for mountings
  std::optional<sensors::MountedSensor> wheels;  ///< of a copy that has, but not for wheels
  std::optional<LogStatements> log;
};

class RecordingFiles;

/// Adds reference.tum and calib.txt where there is something to write, and puts everything in its
/// place with the statements. \throws files::OutputError
void commit_with_sidecar(const Sidecar& sidecar, RecordingFiles& files);

/// The profile of the copy of a recording that stores rings and times with the points.
sensors::LidarProfile stored_in_data(sensors::LidarProfile profile, bool has_rings, bool has_times);

}  // namespace traverse::dataset
