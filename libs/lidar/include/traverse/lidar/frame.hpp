#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/stamp.hpp"
#include "traverse/lidar/feature_class.hpp"
#include "traverse/lidar/registration_health.hpp"
#include "traverse/lidar/scan_lines.hpp"

namespace traverse::lidar {

/// Where the time of a frame went, milliseconds of wall time.
struct StageTimes {
  double organise = 0;  ///< rings, range, vertical correction
  double features = 0;  ///< curvature, classes, thinning
  double deskew = 0;
  double index = 0;  ///< search trees of the local maps
  double associate = 0;
  double solve = 0;
  double insert = 0;  ///< map insertion and dropping of far voxels
  double start = 0;   ///< the search for the initial speed, charged to the first frame

  double total() const {
    return organise + features + deskew + index + associate + solve + insert + start;
  }
};

/// One scan's result.
struct Frame {
  std::size_t index = 0;  ///< of the scan among those fed, from 0
  geometry::Stamp stamp;
  geometry::Pose3 T_map_lidar;
  geometry::Twist velocity = geometry::Twist::Zero();  ///< body twist a second, lidar frame: deskew
  /// Of the pose from the first frame's, as a twist on its right, T_map_lidar Exp(d): d = (rotation
  /// [rad], translation [m]) in the axes of the lidar. Where the odometry tells it.
  std::optional<Matrix6> covariance;
  std::size_t points = 0;
  DroppedPoints dropped;
  std::array<std::size_t, kFeatureClasses> class_counts{};
  std::size_t map_points = 0;
  RegistrationHealth health;
  std::vector<double> further;  ///< one for each of Odometry::further_columns()
  StageTimes ms;
};

}  // namespace traverse::lidar
