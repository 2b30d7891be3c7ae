#include "traverse/voxel_map/matched_points.hpp"

#include <cmath>

#include "traverse/voxel_map/local_points.hpp"

namespace traverse::voxel_map {

namespace {

using Eigen::Vector3d;

Vector3d normal_of(const PlaneRows& rows, std::size_t i) {
  return Vector3d(rows.nx[i], rows.ny[i], rows.nz[i]);
}

/// The recorded point of a row at the scan's stamp, then in the map.
Vector3d point_in_map(const PlaneRows& rows, std::size_t i, const SweepMotion& motion,
                      const geometry::Pose3& T_map_lidar) {
  float x = rows.x[i];
  float y = rows.y[i];
  float z = rows.z[i];
  motion.apply(rows.time[i], x, y, z);
  return T_map_lidar * Vector3d(x, y, z);
}

}  // namespace

std::vector<lidar::MatchedPoint> matched_points(const ScanMatches& matches,
                                                const geometry::Pose3& T_map_lidar,
                                                const geometry::Twist& velocity) {
  const SweepMotion motion(velocity);
  const auto distance = [&](const PlaneRows& rows, std::size_t i, const Vector3d& p_map) {
    return normal_of(rows, i).dot(Vector3d(p_map - matches.origin_map)) + rows.d[i];
  };
  std::vector<lidar::MatchedPoint> points;
  points.reserve(matches.size());
  for (std::size_t i = 0; i < matches.line_1.size(); ++i) {
    const Vector3d p_map = point_in_map(matches.line_1, i, motion, T_map_lidar);
    const Vector3d n1 = normal_of(matches.line_1, i);
    const Vector3d n2 = normal_of(matches.line_2, i);
    const double r1 = distance(matches.line_1, i, p_map);
    const double r2 = distance(matches.line_2, i, p_map);
    points.push_back({lidar::MatchedPoint::Kind::kLine, p_map, p_map - r1 * n1 - r2 * n2,
                      n1.cross(n2).normalized(), std::hypot(r1, r2)});
  }
  for (std::size_t i = 0; i < matches.planes.size(); ++i) {
    const Vector3d p_map = point_in_map(matches.planes, i, motion, T_map_lidar);
    const Vector3d normal = normal_of(matches.planes, i).normalized();
    const double r = distance(matches.planes, i, p_map);
    points.push_back({lidar::MatchedPoint::Kind::kPlane, p_map, p_map - r * normal, normal, r});
  }
  return points;
}

}  // namespace traverse::voxel_map
