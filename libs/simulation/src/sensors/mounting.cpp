#include "traverse/simulation/mounting.hpp"

#include <Eigen/Geometry>

#include "traverse/geometry/angle.hpp"

namespace traverse::simulation {

using config::Range;

geometry::Pose3 Mounting::T_body_sensor() const {
  const Eigen::Quaterniond q =
      Eigen::AngleAxisd(yaw_deg * geometry::kDegree, Eigen::Vector3d::UnitZ()) *
      Eigen::AngleAxisd(pitch_deg * geometry::kDegree, Eigen::Vector3d::UnitY()) *
      Eigen::AngleAxisd(roll_deg * geometry::kDegree, Eigen::Vector3d::UnitX());
  return geometry::Pose3::from_quaternion(q, {x_m, y_m, z_m});
}

void bind(config::Binder& b, Mounting& m) {
  b.number("x_m", m.x_m, Range::between(-20, 20), "ahead of the rear axle");
  b.number("y_m", m.y_m, Range::between(-20, 20), "left of the middle");
  b.number("z_m", m.z_m, Range::between(-20, 20), "above the ground");
  b.number("roll_deg", m.roll_deg, Range::between(-180, 180), "about x, first");
  b.number("pitch_deg", m.pitch_deg, Range::between(-90, 90), "about y, down positive");
  b.number("yaw_deg", m.yaw_deg, Range::between(-180, 180), "about z, last");
}

}  // namespace traverse::simulation
