#pragma once

#include "traverse/geometry/pose3.hpp"
#include "traverse/lidar/observability.hpp"
#include "traverse/parallel/workers.hpp"
#include "traverse/voxel_map/scan_matches.hpp"

namespace traverse::voxel_map {

/// The motion within a sweep as a consequence of the pose: constant since the scan before.
struct MotionModel {
  geometry::Pose3 T_map_previous;
  double interval_s = 0;  ///< since the previous scan
  bool deskew = true;

  /// Body twist a second under which the lidar went from the previous pose to this one; zero when
  /// scans are not deskewed.
  geometry::Twist velocity_at(const geometry::Pose3& T_map_lidar) const;
};

/// The robust cost of a scan at a pose, and its normal equations: the sum over the matches of
///     share * rho(e^2),  rho(e^2) = e^2 k^2 / (k^2 + e^2)   (Geman-McClure),
/// where e^2 is the squared residual over its variance; for a line, of its two rows together.
/// Points follow the pose twice: they are taken to the map by it and deskewed by the motion that
/// ends in it. With s = time / interval, xi the twist over the interval and ad its adjoint, a body
/// perturbation d of the pose moves the point as the perturbation
///     d + s (I + (1 + s) / 2 ad(xi)) d
/// of a point that only the pose moves; terms of the second order in xi are left out.
struct NormalEquations {
  lidar::Matrix6 H =
      lidar::Matrix6::Zero();  ///< J' W J; [rotation (body, right), translation (map, additive)]
  lidar::Vector6 g = lidar::Vector6::Zero();  ///< J' W r, the gradient of cost
  double cost = 0;                            ///< half the sum of share * rho
  double weight = 0;                          ///< sum of the weights of the matches
  double squared_m = 0;  ///< sum of squared distances, unweighted, square metres
  double inliers = 0;    ///< matches with e^2 <= k^2
};

struct ObjectiveOptions {
  double kernel = 3;        ///< k, in robust standard deviations of this scan
  double min_scale = 0.3;   ///< the robust standard deviation is not taken smaller
  double line_weight = 16;  ///< share of a line match; of a plane match 1
};
void bind(config::Binder& binder, ObjectiveOptions& options);

/// Sums in fixed order: the same bits for any number of workers.
NormalEquations evaluate(const ScanMatches& matches, const MotionModel& motion,
                         const geometry::Pose3& T_map_lidar, const ObjectiveOptions& options,
                         parallel::Workers& workers);

}  // namespace traverse::voxel_map
