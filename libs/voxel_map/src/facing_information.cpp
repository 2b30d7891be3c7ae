#include "facing_information.hpp"

#include <cmath>

#include "traverse/voxel_map/local_points.hpp"

namespace traverse::voxel_map {

namespace {

/// Sine of 14 degrees: seven standard deviations of a normal that noise turns by 2 degrees.
constexpr double kFacing = 0.25;

struct Facing {
  double information = 0;
  double weight = 0;

  /// \param velocity_map of the row's point under the unit motion  \param share of a match
  void add(const PlaneRows& rows, std::size_t i, const Eigen::Vector3d& velocity_map,
           double share) {
    const double along = Eigen::Vector3d(rows.nx[i], rows.ny[i], rows.nz[i]).dot(velocity_map);
    const double w = rows.weight[i];
    weight += share * w;
    if (std::abs(along) >= kFacing) information += w * along * along;
  }
};

}  // namespace

double facing_information(const ScanMatches& matches, const geometry::Pose3& T_map_lidar,
                          const MotionModel& motion, const lidar::Vector6& along) {
  const SweepMotion swept(motion.velocity_at(T_map_lidar));
  const Eigen::Vector3d turn = along.head<3>();
  const Eigen::Vector3d shift = along.tail<3>();
  const auto velocity_of = [&](const PlaneRows& rows, std::size_t i) {
    float x = rows.x[i];
    float y = rows.y[i];
    float z = rows.z[i];
    swept.apply(rows.time[i], x, y, z);
    return Eigen::Vector3d(T_map_lidar.rotation * (shift + turn.cross(Eigen::Vector3d(x, y, z))));
  };
  Facing facing;
  for (std::size_t i = 0; i < matches.planes.size(); ++i) {
    facing.add(matches.planes, i, velocity_of(matches.planes, i), 1);
  }
  for (std::size_t i = 0; i < matches.line_1.size(); ++i) {
    const Eigen::Vector3d velocity = velocity_of(matches.line_1, i);
    facing.add(matches.line_1, i, velocity, 0.5);
    facing.add(matches.line_2, i, velocity, 0.5);
  }
  return facing.weight > 0 ? facing.information / facing.weight : 0;
}

}  // namespace traverse::voxel_map
