#include "traverse/slam/odometry_chain.hpp"

#include <algorithm>

namespace traverse::slam {

void OdometryChain::add(const geometry::Pose3& T_odom_lidar,
                        const geometry::Matrix6& step_covariance) {
  if (poses_.empty()) {
    poses_.push_back(T_odom_lidar);
    sums_.push_back(geometry::Matrix6::Zero());
    way_m_.push_back(0);
    return;
  }
  const geometry::Pose3 step = poses_.back().inverse() * T_odom_lidar;
  // A step's translation is told in the axes of its start; the twist's is in those of its end.
  geometry::Matrix6 to_odom = geometry::Matrix6::Identity();
  to_odom.bottomRightCorner<3, 3>() = step.rotation.transpose();
  to_odom = geometry::adjoint(T_odom_lidar) * to_odom;
  sums_.push_back(sums_.back() + to_odom * step_covariance * to_odom.transpose());
  way_m_.push_back(way_m_.back() + step.translation.norm());
  poses_.push_back(T_odom_lidar);
}

geometry::Pose3 OdometryChain::motion(std::size_t i, std::size_t j) const {
  return poses_.at(i).inverse() * poses_.at(j);
}

geometry::Matrix6 OdometryChain::covariance(std::size_t i, std::size_t j) const {
  const geometry::Matrix6 sum = sums_.at(std::max(i, j)) - sums_.at(std::min(i, j));
  const geometry::Matrix6 to_j = geometry::adjoint(poses_.at(j).inverse());
  return to_j * sum * to_j.transpose();
}

}  // namespace traverse::slam
