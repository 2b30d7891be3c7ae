#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"

namespace traverse::plausibility {

/// Points of a scan as they are stored, and how the lidar moved.
struct TimedScan {
  geometry::Pose3 T_map_lidar;                         ///< at the stamp
  geometry::Twist velocity = geometry::Twist::Zero();  ///< rad/s, m/s, lidar frame
  std::vector<Eigen::Vector3f> points;                 ///< metres, lidar frame
  std::vector<float> times;                            ///< of each point, seconds after the stamp
};

/// How much of the motion within a sweep is in the points of two scans that see one place.
struct Distortion {
  double share =
      0;  ///< 1: all of it, they are raw; 0: none, they are compensated; -1: times run back
  double sigma = 0;  ///< standard deviation of the share
  double rms_m = 0;  ///< distances that are left
  double score = 0;  ///< how many points it brings onto planes, each by how near it is
};

/// Points of `b` on planes of `a`, for the rigid motion between them and the share s at once: raw
/// points p were measured where the lidar was at their time t, so that s t (w x p + v) brings them
/// to the stamp. A surface is seen by both at another azimuth, hence at another time of the sweep:
/// with the wrong share it is in two places. Robust least squares (Tukey's biweight), Gauss-Newton
/// from the poses that are given. \returns nothing if there are too few planes in common or they do
/// not tell
std::optional<Distortion> fit_distortion(const TimedScan& a, const TimedScan& b);

}  // namespace traverse::plausibility
