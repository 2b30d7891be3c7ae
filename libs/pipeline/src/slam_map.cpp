#include "traverse/pipeline/slam_map.hpp"

#include <vector>

#include "traverse/slam/slam.hpp"

namespace traverse::pipeline {

geometry::Pose3 SlamMap::T_map_lidarmap() const {
  return slam_->graph().is_georeferenced() ? geometry::Pose3::identity() : T_body_lidar_;
}

geometry::Pose3 SlamMap::optimised(std::size_t keyframe) const {
  return T_map_lidarmap() * slam_->pose(keyframe);
}

geometry::Pose3 SlamMap::by_odometry(std::size_t keyframe) const {
  return T_body_lidar_ * slam_->chain().T_odom_lidar(keyframe);
}

geometry::Trajectory SlamMap::corrected(const geometry::Trajectory& T_map_body) const {
  if (!slam_->is_corrected()) return T_map_body;
  const geometry::Trajectory by_odometry =
      T_map_body.transformed_left(T_body_lidar_.inverse()).transformed_right(T_body_lidar_);
  std::vector<geometry::Pose3> poses = slam_->corrected(by_odometry.stamps(), by_odometry.poses());
  return geometry::Trajectory::stamped(T_map_body.stamps(), std::move(poses))
      .transformed_left(T_map_lidarmap())
      .transformed_right(T_body_lidar_.inverse());
}

}  // namespace traverse::pipeline
