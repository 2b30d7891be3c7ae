#pragma once

#include <optional>

#include "traverse/config/binder.hpp"
#include "traverse/lidar/corrected_scan.hpp"
#include "traverse/lidar/frame.hpp"
#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"
#include "traverse/slam/keyframe.hpp"

namespace traverse::slam {

/// How far the motion between two keyframes may be off. The solver's information alone says
/// millimetres, because neighbouring scans share their map and its errors.
struct StepNoiseOptions {
  double inflation = 100;             ///< of the covariance from the solver's information
  double drift_m_per_sqrt_m = 0.015;  ///< a random walk beside it, by the way gone
  double drift_deg_per_sqrt_m = 0.015;
  double unregistered_m = 0.5;  ///< more for every frame whose pose is only predicted
  double unregistered_deg = 2;
};
void bind(config::Binder& binder, StepNoiseOptions& options);

struct KeyframeOptions {
  double spacing_m = 2;     ///< a new keyframe after so much motion
  double spacing_deg = 20;  ///< or so much rotation
  double cube_m = 0.1;      ///< of a keyframe's map points one a cube of this edge is kept
  StepNoiseOptions noise;
  voxel_map::SamplingOptions sampling;
};
void bind(config::Binder& binder, KeyframeOptions& options);

/// Makes keyframes of the frames that any lidar odometry tells. A value.
class KeyframeMaker {
 public:
  KeyframeMaker(const KeyframeOptions& options, const sensors::LidarProfile& profile);

  /// Takes note of the next frame. \returns whether it shall become a keyframe: the first one, and
  /// those that are far enough from the keyframe before.
  bool observe(const lidar::Frame& frame);

  /// The keyframe of the frame just observed. \param points its scan as odometry used it, deskewed
  /// \param deskewed whether odometry deskews scans of this recording by Frame::velocity
  Keyframe make(const lidar::Frame& frame, const sensors::LidarScan& scan,
                const lidar::CorrectedScan& points, bool deskewed);

 private:
  geometry::Matrix6 step_covariance(const geometry::Pose3& T_i_j) const;

  KeyframeOptions options_;
  sensors::LidarProfile profile_;
  std::size_t made_ = 0;
  geometry::Pose3 T_odom_last_;
  // Since the last keyframe: the registration that determines its pose least, and how many failed.
  std::optional<lidar::RegistrationHealth> weakest_;
  int unregistered_ = 0;
};

/// The features of a scan moved to where they stood at its stamp.
voxel_map::SweepSample deskewed(voxel_map::SweepSample sample, const geometry::Twist& velocity);

}  // namespace traverse::slam
