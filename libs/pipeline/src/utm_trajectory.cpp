#include "traverse/pipeline/utm_trajectory.hpp"

#include "traverse/geometry/angle.hpp"
#include "traverse/geometry/so3.hpp"

namespace traverse::pipeline {

UtmTrajectory to_utm(const geometry::Trajectory& T_map_body, const geodesy::Geodetic& origin) {
  const geodesy::LocalTangentPlane map(origin);
  const geodesy::Utm first = geodesy::to_utm(origin);
  UtmTrajectory result{first.zone, first.is_north, {}};
  for (std::size_t k = 0; k < T_map_body.size(); ++k) {
    const geometry::Pose3& pose = T_map_body.pose(k);
    const geodesy::Geodetic place = map.to_geodetic(pose.translation);
    const geodesy::Utm utm = geodesy::to_utm(place, first.zone);
    const Eigen::Matrix3d R_here_map =
        geodesy::LocalTangentPlane(place).R_enu_ecef() * map.R_enu_ecef().transpose();
    // A grid heading is the true one less the convergence, clockwise; counterclockwise it adds.
    const Eigen::Matrix3d R_grid_here =
        geometry::exp_so3({0, 0, utm.convergence_deg * geometry::kDegree});
    result.T_utm_body.push_back(T_map_body.stamp(k),
                                {R_grid_here * R_here_map * pose.rotation,
                                 {utm.easting_m, utm.northing_m, utm.altitude_m}});
  }
  return result;
}

}  // namespace traverse::pipeline
