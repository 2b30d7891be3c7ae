#include "traverse/simulation/drive.hpp"

#include <cmath>
#include <numbers>

namespace traverse::simulation {

geometry::Pose3 Drive::pose(double seconds) const {
  const double k = 2 * std::numbers::pi / wavelength_m;
  const double x = speed_mps * seconds;
  const double yaw = std::atan(amplitude_m * k * std::cos(k * x));
  const double roll = sway * std::sin(1.3 * seconds);
  const double pitch = sway * std::sin(0.9 * seconds);
  const Eigen::Quaterniond q = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
  return geometry::Pose3::from_quaternion(q, {x, amplitude_m * std::sin(k * x), lidar_height_m});
}

}  // namespace traverse::simulation
