#pragma once

#include <cstddef>
#include <optional>

#include "traverse/geodesy/local_tangent_plane.hpp"
#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/trajectory.hpp"

namespace traverse::slam {
class Slam;
}

namespace traverse::pipeline {

/// Loops that were closed over a lidar odometry, in the frames of the vehicle: the map frame is the
/// body frame of the first scan, or ENU if fixes orient it. A view of an estimator's state.
class SlamMap {
 public:
  SlamMap(const slam::Slam& slam, const geometry::Pose3& T_body_lidar,
          const std::optional<geodesy::Geodetic>& origin)
      : slam_(&slam), T_body_lidar_(T_body_lidar), origin_(origin) {}

  const slam::Slam& slam() const { return *slam_; }
  const geometry::Pose3& T_body_lidar() const { return T_body_lidar_; }

  /// Of the map frame, if it is ENU.
  const std::optional<geodesy::Geodetic>& origin() const { return origin_; }

  /// T_map_lidar of a keyframe by the last solution, and by odometry alone.
  geometry::Pose3 optimised(std::size_t keyframe) const;
  geometry::Pose3 by_odometry(std::size_t keyframe) const;

  /// The optimised poses of the frames that odometry told. Where nothing was learned after them
  /// they are the same bits.
  geometry::Trajectory corrected(const geometry::Trajectory& T_map_body_by_odometry) const;

 private:
  /// From the lidar's map frame to the vehicle's.
  geometry::Pose3 T_map_lidarmap() const;

  const slam::Slam* slam_;
  geometry::Pose3 T_body_lidar_;
  std::optional<geodesy::Geodetic> origin_;
};

}  // namespace traverse::pipeline
