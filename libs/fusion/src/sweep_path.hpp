#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"
#include "traverse/inertial/nav_state.hpp"
#include "traverse/lidar/corrected_scan.hpp"
#include "traverse/sensors/imu_sample.hpp"
#include "traverse/voxel_map/sweep_points.hpp"

namespace traverse::fusion {

/// How the lidar went during a sweep, seen from where it was in the middle: from the readings of
/// the IMU less the biases of the state in the middle, both ways from there.
class SweepPath {
 public:
  SweepPath() = default;

  /// \param readings  over the whole of it, in the lidar's axes
  /// \param middle  the state of the IMU in the middle of the sweep  \param gravity_map  [m/s^2]
  /// \param p_lidar_body  of the lidar from the IMU, in the lidar's axes [m]
  /// \param first_s, last_s  what it spans, seconds after the middle
  SweepPath(std::span<const sensors::ImuSample> readings, const inertial::NavState& middle,
            const Eigen::Vector3d& gravity_map, const Eigen::Vector3d& p_lidar_body, double first_s,
            double last_s);

  /// T_middle_lidar at a moment, which is taken into the span.
  geometry::Pose3 at(double seconds) const;

  /// The points as if all had been measured in the middle; times are what SweepPoints say.
  /// \param moved  coordinates are written; it has room for them already
  void apply(const voxel_map::SweepPoints& points, voxel_map::SweepPoints& moved) const;

  /// Points [m] whose times count from `zero_s` after the middle, seen from where the lidar was
  /// then.
  void apply(const std::vector<float>& times, double zero_s, lidar::CorrectedScan& points) const;

  /// The constant body twist a second that leads from one end to the other.
  geometry::Twist mean_velocity() const;

 private:
  /// Rotation by rows, then translation.
  using Knot = std::array<float, 12>;
  std::size_t place(double seconds, float& share) const;
  void move(float time, float& x, float& y, float& z) const;

  double first_s_ = 0;
  double step_s_ = 1;
  std::vector<Knot> knots_{Knot{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}};
};

}  // namespace traverse::fusion
