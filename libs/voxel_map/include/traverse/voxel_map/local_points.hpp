#pragma once

#include <vector>

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"
#include "traverse/parallel/workers.hpp"
#include "traverse/voxel_map/sweep_points.hpp"

namespace traverse::voxel_map {

/// Points in the axes of the map, as floats relative to an origin near the vehicle.
struct LocalPoints {
  Eigen::Vector3d origin_map = Eigen::Vector3d::Zero();
  std::vector<float> x, y, z;  ///< metres

  std::size_t size() const { return x.size(); }
};

/// The motion within a sweep as floats, for loops: p_stamp = Exp(time * velocity) p to the third
/// order of time, which for 3 rad/s and half a sweep of 0.1 s is right to 2e-5 of the range.
struct SweepMotion {
  float w[3], v[3];  ///< rad/s, m/s, lidar frame

  explicit SweepMotion(const geometry::Twist& velocity);

  /// \tparam Value float, or a vector of floats
  template <typename Value>
  void apply(const Value& time, Value& x, Value& y, Value& z) const {
    const Value ax = w[1] * z - w[2] * y + v[0];
    const Value ay = w[2] * x - w[0] * z + v[1];
    const Value az = w[0] * y - w[1] * x + v[2];
    const Value bx = w[1] * az - w[2] * ay;
    const Value by = w[2] * ax - w[0] * az;
    const Value bz = w[0] * ay - w[1] * ax;
    const Value cx = w[1] * bz - w[2] * by;
    const Value cy = w[2] * bx - w[0] * bz;
    const Value cz = w[0] * by - w[1] * bx;
    const Value second = 0.5F * time * time;
    const Value third = time * second * (1.0F / 3);
    x += time * ax + second * bx + third * cx;
    y += time * ay + second * by + third * cy;
    z += time * az + second * bz + third * cz;
  }
};

/// Deskews `points` with the body `velocity` [rad/s, m/s] and takes them to the map.
void to_local(const SweepPoints& points, const geometry::Pose3& T_map_lidar,
              const geometry::Twist& velocity, parallel::Workers& workers, LocalPoints& local);

}  // namespace traverse::voxel_map
