#include "matched_points.hpp"

#include "traverse/loam/residuals.hpp"

namespace traverse::loam {

std::vector<lidar::MatchedPoint> matched_points(const Matches& matches,
                                                const geometry::Pose3& T_map_lidar) {
  std::vector<lidar::MatchedPoint> points;
  points.reserve(matches.size());
  for (const LineMatch& match : matches.lines) {
    const Line& line = match.line;
    const Eigen::Vector3d q = T_map_lidar * match.p_lidar;
    const Eigen::Vector3d foot =
        line.point + line.direction * line.direction.dot(Eigen::Vector3d(q - line.point));
    points.push_back(
        {lidar::MatchedPoint::Kind::kLine, q, foot, line.direction, (q - foot).norm()});
  }
  for (const PlaneMatch& match : matches.planes) {
    const Eigen::Vector3d q = T_map_lidar * match.p_lidar;
    const double residual = plane_residual(match.plane, q);
    points.push_back({lidar::MatchedPoint::Kind::kPlane, q, q - residual * match.plane.normal,
                      match.plane.normal, residual});
  }
  return points;
}

}  // namespace traverse::loam
