#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "traverse/geometry/pose3.hpp"
#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/wheel_encoder.hpp"

namespace traverse::sensors {

enum class SensorKind { kLidar, kPlanarLaser, kImu, kGnss, kWheels };

/// The word that people use: "lidar", "2-D laser", "IMU", "GNSS", "wheels".
std::string_view name_of(SensorKind kind);

/// One sensor and where it sits on the vehicle.
struct MountedSensor {
  std::string label;  ///< as in Measurement::sensor
  SensorKind kind = SensorKind::kLidar;
  /// Of a GNSS antenna the position; its rotation about z is that of the baseline of two antennas
  /// whose heading a fix tells. Of wheels the middle of the axle that they are on.
  geometry::Pose3 T_body_sensor;
  std::optional<LidarProfile> lidar;         ///< set for kLidar
  std::optional<WheelEncoder> encoder = {};  ///< for kWheels, where it is known
};

/// The sensors of a vehicle and their calibration.
struct Rig {
  std::string body_frame = "body";  ///< what `body` is: "lidar", "camera 0", "vehicle"
  std::vector<MountedSensor> sensors;

  /// The sensor with `label`, or null.
  const MountedSensor* find(std::string_view label) const;
  /// The first sensor of `kind`, or null.
  const MountedSensor* first(SensorKind kind) const;
};

}  // namespace traverse::sensors
