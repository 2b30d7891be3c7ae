#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"

#include "recording/folder_source.hpp"

namespace traverse::dataset {

/// One packet of KITTI raw's inertial navigation system: axes x forward, y left, z up.
struct OxtsPacket {
  geometry::Stamp stamp;
  double latitude_deg = 0;
  double longitude_deg = 0;
  double altitude_m = 0;
  double roll = 0;                                           ///< rad
  double pitch = 0;                                          ///< rad, downward positive
  double yaw = 0;                                            ///< rad, 0 is east, counterclockwise
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();  ///< m/s^2
  Eigen::Vector3d angular_rate = Eigen::Vector3d::Zero();    ///< rad/s
  double position_accuracy_m = 0;
};

/// Reads oxts/data/*.txt.
class OxtsReader {
 public:
  /// The order of the values is that of dataformat.txt, if there, else KITTI's.
  /// \throws files::InputError if dataformat.txt lacks a value that is needed.
  explicit OxtsReader(const std::filesystem::path& dataformat);

  /// \throws files::InputError
  OxtsPacket read(const std::filesystem::path& file, geometry::Stamp stamp) const;

 private:
  std::size_t column_of(const std::string& name) const;

  std::vector<std::string> names_;
};

/// The measurements of a packet: what the IMU felt and where the GNSS was.
sensors::ImuSample imu_sample(const OxtsPacket& packet, const std::string& label);
sensors::GnssFix gnss_fix(const OxtsPacket& packet, const std::string& label);

/// The path of the IMU from its first pose, on a Mercator map scaled by the first latitude: the
/// devkit's convertOxtsToPose. Source: Geiger et al., KITTI raw data development kit.
geometry::Trajectory mercator_trajectory(const std::vector<OxtsPacket>& packets);

/// Unit vector to true north in the frame of the IMU at that packet.
Eigen::Vector3d north_imu(const OxtsPacket& packet);

}  // namespace traverse::dataset
