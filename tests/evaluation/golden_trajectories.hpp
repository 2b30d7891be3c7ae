#pragma once

#include <cmath>

#include <Eigen/Geometry>

#include "traverse/geometry/trajectory.hpp"

/// A reference and an estimate in closed form, whose figures are known: a rising circle, and the
/// same seen from another map frame, 2 % too large, with a slow drift and a wobble, every seventh
/// pose missing and the stamps a few milliseconds off.
namespace traverse::testing {

inline geometry::Pose3 pose_of(const Eigen::AngleAxisd& a, const Eigen::AngleAxisd& b,
                               const Eigen::AngleAxisd& c, const Eigen::Vector3d& t) {
  return {(a.toRotationMatrix() * b.toRotationMatrix() * c.toRotationMatrix()), t};
}

inline Eigen::AngleAxisd about_x(double angle) { return {angle, Eigen::Vector3d::UnitX()}; }
inline Eigen::AngleAxisd about_y(double angle) { return {angle, Eigen::Vector3d::UnitY()}; }
inline Eigen::AngleAxisd about_z(double angle) { return {angle, Eigen::Vector3d::UnitZ()}; }

inline geometry::Pose3 golden_reference_pose(double i) {
  return pose_of(about_z(.01 * i), about_y(.1 * std::sin(.05 * i)),
                 about_x(.05 * std::cos(.03 * i)),
                 {100 * std::sin(.01 * i), 100 * (1 - std::cos(.01 * i)), 2 * std::sin(.02 * i)});
}

inline geometry::Trajectory golden_reference() {
  geometry::Trajectory reference;
  for (int i = 0; i < 600; ++i) {
    reference.push_back(geometry::Stamp::from_seconds(.1 * i), golden_reference_pose(i));
  }
  return reference;
}

inline geometry::Trajectory golden_estimate() {
  const geometry::Pose3 A = pose_of(about_z(.3), about_x(-.1), about_x(0), {5, -3, 1});
  geometry::Trajectory estimate;
  for (int k = 0; k < 600; ++k) {
    if (k % 7 == 3) continue;
    const double i = k;
    const geometry::Pose3 D = pose_of(
        about_z(1e-4 * i + .002 * std::sin(.7 * i)), about_y(.001 * std::cos(.4 * i)), about_x(0),
        {.02 * std::sin(.9 * i) + 1e-3 * i, .015 * std::cos(1.1 * i), .01 * std::sin(.3 * i)});
    geometry::Pose3 pose = A * golden_reference_pose(i) * D;
    pose.translation *= 1.02;
    estimate.push_back(geometry::Stamp::from_seconds(.1 * i + .003 * std::sin(i)), pose);
  }
  return estimate;
}

}  // namespace traverse::testing
