#pragma once

#include "traverse/geometry/pose3.hpp"
#include "traverse/lidar/observability.hpp"
#include "traverse/voxel_map/pose_uncertainty.hpp"

namespace traverse::voxel_map {

/// PoseUncertainty of a lidar alone. Directions that the matches do not determine go on at the last
/// speed; how far that leads astray is told by how the speed has changed where it was seen.
class LidarUncertainty {
 public:
  LidarUncertainty() = default;
  /// Goes on from what another odometry knows.
  explicit LidarUncertainty(const PoseUncertainty& pose) : pose_(pose) {}

  /// \param seen  as judged of the matches  \param speed_change  body twist a second, since the
  /// scan before  \param seconds  since then
  void add(ScanEvidence evidence, const lidar::Observability& seen,
           const geometry::Pose3& T_map_lidar, const geometry::Twist& speed_change, double seconds);
  /// A scan that was not registered.
  void add_predicted(const geometry::Pose3& T_map_lidar, double seconds);

  const PoseUncertainty& pose() const { return pose_; }

 private:
  static lidar::Matrix6 first_change();
  lidar::Matrix6 growth(const geometry::Pose3& T_map_lidar, const lidar::Matrix6& unseen,
                        double seconds);

  PoseUncertainty pose_;
  // Changes of speed from scan to scan, in the axes of the lidar: alike for a second.
  lidar::Vector6 changing_ = lidar::Vector6::Zero();
  double changing_weight_ = 0;
  // Before any was seen as much as vehicles do, counted as one.
  lidar::Matrix6 change_ = first_change();
  double change_weight_ = 1;
  // What the speed is off by where it is not seen, and what it has to do with the pose's error.
  lidar::Matrix6 speed_ = lidar::Matrix6::Zero();
  lidar::Matrix6 pose_by_speed_ = lidar::Matrix6::Zero();
};

}  // namespace traverse::voxel_map
