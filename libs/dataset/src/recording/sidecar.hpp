#pragma once

#include <optional>
#include <string>

#include "traverse/dataset/source.hpp"
#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/rig.hpp"

#include "navigation_log/log_statements.hpp"
#include "recording/vehicle_statements.hpp"

namespace traverse::dataset {

/// The topics that a bag's sensors are read from; empty: none of that kind.
struct BagStatements {
  std::string lidar;
  std::string imu;
  std::string gnss;
  std::string wheels;
  std::string laser;
  bool has_times = false;  ///< of points: seconds after the stamp
};

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
  std::optional<BagStatements> bag;
};

class RecordingFiles;

/// Adds reference.tum and calib.txt where there is something to write, and puts everything in its
/// place with the statements. \throws files::OutputError
void commit_with_sidecar(const Sidecar& sidecar, RecordingFiles& files);

/// What holds of a copy that keeps the body and all sensors of `info`, with rings and times in the
/// points as far as these were found.
Sidecar sidecar_of_whole_rig(const RecordingInfo& info, const std::optional<Reference>& reference,
                             bool has_rings, bool has_times);

/// The profile of the copy of a recording that stores rings and times with the points.
sensors::LidarProfile stored_in_data(sensors::LidarProfile profile, bool has_rings, bool has_times);

}  // namespace traverse::dataset
