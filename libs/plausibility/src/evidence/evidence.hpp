#pragma once

#include <map>
#include <optional>
#include <string>

#include "traverse/dataset/source.hpp"
#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/stamp.hpp"
#include "traverse/sensors/measurement.hpp"

#include "evidence/distortion_track.hpp"
#include "evidence/gnss_track.hpp"
#include "evidence/imu_track.hpp"
#include "evidence/lidar_track.hpp"
#include "evidence/wheel_track.hpp"

namespace traverse::plausibility {

/// The path of a lidar odometry.
struct OdometryTrack {
  void take(double t, const geometry::Pose3& T_map_body);

  Accumulated<3> turn;     ///< rotation in the body's axes [rad]
  Accumulated<3> way;      ///< in the map's axes [m]: between two moments the chord
  Accumulated<1> forward;  ///< along the body's x axis [m], negative in reverse

 private:
  std::optional<double> last_t_;
  geometry::Pose3 last_;
};

/// All that the checks look at. Times are seconds from the first stamp that came.
struct Evidence {
  explicit Evidence(const dataset::RecordingInfo& info) : recording(info) {}

  void take(const sensors::Measurement& measurement);
  void take_pose(geometry::Stamp stamp, const geometry::Pose3& T_map_body);

  const dataset::RecordingInfo& recording;
  std::map<std::string, LidarTrack> lidars;  ///< by label
  std::map<std::string, ImuTrack> imus;
  std::map<std::string, GnssTrack> receivers;
  std::map<std::string, WheelTrack> wheels;
  OdometryTrack odometry;
  DistortionTrack distortion;  ///< of the first lidar

  /// Of the IMU's axes in the body; the identity for one that is not in the rig.
  Eigen::Matrix3d R_body(const std::string& sensor) const;

 private:
  double seconds(geometry::Stamp stamp);

  std::optional<geometry::Stamp> origin_;
};

}  // namespace traverse::plausibility
