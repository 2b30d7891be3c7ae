#pragma once

#include <vector>

#include <Eigen/Core>

#include "traverse/lidar/timed_points.hpp"
#include "traverse/loam/local_map.hpp"

namespace traverse::testing {

/// A room of 20 x 16 x 4 m about the origin, its walls, floor and ceiling sampled every `step`
/// metres: planar points; its four upright corners: edge points. Map frame.
struct Room {
  std::vector<Eigen::Vector3d> planar;
  std::vector<Eigen::Vector3d> edges;

  explicit Room(double step) {
    for (double a = -10; a <= 10; a += step) {
      for (double b = -8; b <= 8; b += step) {
        planar.emplace_back(a, b, -2);
        planar.emplace_back(a, b, 2);
      }
      for (double z = -2; z <= 2; z += step) {
        planar.emplace_back(a, -8, z);
        planar.emplace_back(a, 8, z);
      }
    }
    for (double z = -2; z <= 2; z += step) {
      for (double b = -8; b <= 8; b += step) {
        planar.emplace_back(-10, b, z);
        planar.emplace_back(10, b, z);
      }
      for (const double x : {-10.0, 10.0}) {
        for (const double y : {-8.0, 8.0}) edges.emplace_back(x, y, z);
      }
    }
  }

  static loam::LocalMap map_of(const std::vector<Eigen::Vector3d>& points) {
    loam::LocalMap map(0.05, 100);
    map.insert(points);
    map.build_index();
    return map;
  }
};

/// Map points as the lidar at `T_map_lidar` sees them.
inline lidar::TimedPoints seen_from(const geometry::Pose3& T_map_lidar,
                                    const std::vector<Eigen::Vector3d>& points_map) {
  const geometry::Pose3 T_lidar_map = T_map_lidar.inverse();
  lidar::TimedPoints points;
  for (const auto& p_map : points_map) {
    const Eigen::Vector3f p = (T_lidar_map * p_map).cast<float>();
    points.push_back(p.x(), p.y(), p.z(), 0);
  }
  return points;
}

}  // namespace traverse::testing
