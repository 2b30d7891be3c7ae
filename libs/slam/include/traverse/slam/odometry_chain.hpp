#pragma once

#include <cstddef>
#include <vector>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/se3.hpp"

namespace traverse::slam {

/// How far the way between two keyframes may be off by odometry alone. Steps err independently, so
/// their covariances, each taken to the odometry frame by the adjoint of its pose, add up; sums
/// over any stretch are differences of prefix sums. (Barfoot, "State Estimation for Robotics",
/// 2017, section 7.3.2, to first order.)
class OdometryChain {
 public:
  /// \param step_covariance as Keyframe::step_covariance
  void add(const geometry::Pose3& T_odom_lidar, const geometry::Matrix6& step_covariance);

  std::size_t size() const { return poses_.size(); }
  const geometry::Pose3& T_odom_lidar(std::size_t i) const { return poses_.at(i); }

  /// T_i_j, i and j in either order.
  geometry::Pose3 motion(std::size_t i, std::size_t j) const;
  /// Covariance of the twist d [rotation, translation] with true T_i_j = T_i_j Exp(d): axes of j.
  geometry::Matrix6 covariance(std::size_t i, std::size_t j) const;
  /// Metres of way from keyframe i to j, i <= j.
  double way_m(std::size_t i, std::size_t j) const { return way_m_.at(j) - way_m_.at(i); }

 private:
  std::vector<geometry::Pose3> poses_;
  std::vector<geometry::Matrix6> sums_;  ///< of steps up to and with this one, odometry frame
  std::vector<double> way_m_;
};

}  // namespace traverse::slam
