#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/se3.hpp"
#include "traverse/geometry/stamp.hpp"
#include "traverse/lidar/frame.hpp"
#include "traverse/voxel_map/sweep_sample.hpp"

namespace traverse::slam {

/// The points of a keyframe for maps: usable, corrected and deskewed to the keyframe's stamp, of
/// each small cube the first. Structure of arrays.
struct KeyframePoints {
  std::vector<float> x, y, z;       ///< metres, lidar frame at the stamp
  std::vector<float> intensity;     ///< 0 .. 1; empty, or one a point
  std::vector<float> time;          ///< seconds after the stamp; empty, or one a point
  std::vector<std::uint16_t> ring;  ///< as the recording counts them; empty, or one a point

  std::size_t size() const { return x.size(); }
};

/// A scan that the map is made of.
struct Keyframe {
  std::size_t id = 0;  ///< number among the keyframes, from 0
  geometry::Stamp stamp;
  geometry::Pose3 T_odom_lidar;  ///< by odometry; the optimised poses are the pose graph's

  KeyframePoints points;
  /// What scans are registered by, deskewed: every time is zero and velocity no longer matters.
  voxel_map::SweepSample features;

  /// Of the motion T_i_j from the keyframe before (i) to this one (j): [rotation, rad, right
  /// perturbation, axes of j; translation, metres, axes of i]. Zero for the first keyframe.
  geometry::Matrix6 step_covariance = geometry::Matrix6::Zero();
  lidar::RegistrationHealth health;  ///< of the scan's registration by odometry
};

}  // namespace traverse::slam
