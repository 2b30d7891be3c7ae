#include "match_observability.hpp"

#include <algorithm>
#include <vector>

#include "traverse/statistics/quantile.hpp"

#include "point_motion.hpp"

namespace traverse::loam {

namespace {

double median_range(const Matches& matches) {
  std::vector<double> ranges;
  ranges.reserve(matches.size());
  for (const auto& match : matches.lines) ranges.push_back(match.p_lidar.norm());
  for (const auto& match : matches.planes) ranges.push_back(match.p_lidar.norm());
  if (ranges.empty()) return 1;
  return std::max(statistics::element_at_share(ranges, 0.5), 1e-3);
}

}  // namespace

lidar::Observability observability(const Matches& matches, const geometry::Pose3& T_map_lidar,
                                   double min_eigenvalue) {
  lidar::Observability result;
  if (matches.size() == 0) {
    result.degenerate = 6;
    return result;
  }
  const double rotation_scale_m = median_range(matches);
  const Eigen::Matrix3d R_lidar_map = T_map_lidar.rotation.transpose();
  const Eigen::Quaterniond q = T_map_lidar.quaternion();
  const Eigen::Vector3d& t = T_map_lidar.translation;

  // A unit normal n of the map sees the body twist as [p x n, n] in body axes. A line is seen
  // through the two normals across it: I - u u' in place of n n'.
  lidar::Matrix6 information = lidar::Matrix6::Zero();
  const auto add = [&](const auto& match, const Eigen::Vector3d& n_map) {
    const Eigen::Vector3d n = R_lidar_map * n_map;
    lidar::Vector6 row;
    if (match.fraction == 1) {
      row << match.p_lidar.cross(n) / rotation_scale_m, n;
    } else {
      const PointMotion motion(match.p_lidar, match.fraction, optimization::Perturbation::kRight);
      const Eigen::RowVector3d by_rotation =
          motion.by_rotation(Eigen::RowVector3d(n_map.transpose()), motion.at(q, t));
      row << by_rotation.transpose() / rotation_scale_m, match.fraction * n;
    }
    information.selfadjointView<Eigen::Lower>().rankUpdate(row);
  };
  for (const auto& match : matches.planes) add(match, match.plane.normal);
  for (const auto& match : matches.lines) {
    const Eigen::Vector3d e = match.line.direction.unitOrthogonal();
    add(match, e);
    add(match, match.line.direction.cross(e));
  }
  information = lidar::Matrix6(information.selfadjointView<Eigen::Lower>());
  information /= static_cast<double>(matches.size());
  return lidar::observability(information, rotation_scale_m, min_eigenvalue);
}

}  // namespace traverse::loam
