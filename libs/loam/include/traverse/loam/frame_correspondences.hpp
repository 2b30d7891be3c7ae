#pragma once

#include <span>

#include "traverse/geometry/pose3.hpp"
#include "traverse/loam/association.hpp"
#include "traverse/loam/scan_to_map_odometry.hpp"
#include "traverse/sensors/lidar_profile.hpp"
#include "traverse/sensors/lidar_scan.hpp"

namespace traverse::loam {

/// What one frame of a recording gives a solver to work on, so that solvers can be compared on the
/// same correspondences.
struct FrameCorrespondences {
  Matches matches;  ///< deskewed points of the frame with lines and planes of the local map
  geometry::Pose3 guess_T_map_lidar;  ///< the prediction

  /// The same pairs as LOAM's scan-to-scan stage has them: points as they were measured, each with
  /// its share of the sweep's motion; lines and planes in the frame of the lidar at the begin of
  /// the sweep. Empty if scans are not deskewed or the times of the points are not known.
  Matches swept;
  geometry::Pose3 guess_T_begin_end;  ///< motion over the sweep, predicted
};

/// Leads scan-to-map odometry through all scans but the last, and associates the last.
/// \param motion_compensated the scans need no deskew
/// \throws std::invalid_argument for less than two scans; sensors::NoRings
FrameCorrespondences correspondences_of_last(std::span<const sensors::LidarScan> scans,
                                             const sensors::LidarProfile& profile,
                                             bool motion_compensated,
                                             const ScanToMapOdometryOptions& options);

}  // namespace traverse::loam
