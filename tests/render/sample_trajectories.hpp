#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "traverse/geometry/trajectory.hpp"

namespace traverse::render {

/// A drive along a rounded square with hills, ten poses a second, beginning at `origin`.
inline geometry::Trajectory square_drive(std::size_t poses, const Eigen::Vector3d& origin,
                                         double drift = 0) {
  std::vector<geometry::Stamp> stamps;
  std::vector<geometry::Pose3> path;
  Eigen::Vector3d position = origin;
  for (std::size_t i = 0; i < poses; ++i) {
    const double s = static_cast<double>(i);
    const double heading = std::floor(s / 50) * M_PI / 2 + drift * s;
    geometry::Pose3 pose;
    pose.translation = position;
    path.push_back(pose);
    stamps.push_back(geometry::Stamp::from_seconds(1.3e9 + 0.1 * s));
    position += Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.1 * std::sin(s / 9));
  }
  return geometry::Trajectory::stamped(std::move(stamps), std::move(path));
}

}  // namespace traverse::render
