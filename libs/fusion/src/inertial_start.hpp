#pragma once

#include <optional>
#include <span>
#include <string>

#include "traverse/fusion/inertial_odometry.hpp"
#include "traverse/inertial/nav_state.hpp"

#include "imu_readings.hpp"

namespace traverse::fusion {

/// Where the lidar alone says that it was in the middle of a sweep.
struct Sighting {
  geometry::Stamp stamp;
  geometry::Pose3 T_map_lidar;
};

/// What fusion begins with.
struct FirstState {
  inertial::NavState state;  ///< at the last sighting, of the IMU in the lidar's axes
  Eigen::Vector3d gravity_map = Eigen::Vector3d::Zero();  ///< m/s^2
  inertial::NavState::Tangent sigma;
  bool was_standing = false;
  std::string how;  ///< in words
};

struct StartVerdict {
  std::optional<FirstState> first;
  std::string why_not;
  bool is_contradiction = false;  ///< the IMU cannot be right
};

/// Gravity, velocity and the gyro's bias from the poses that the lidar alone found and what the IMU
/// read meanwhile. Standing still, gravity is the mean specific force and the bias the mean rate.
/// In motion both follow from the sightings over StartOptions::moving_s by least squares: rotations
/// give the bias, positions
///     p(t) = p0 + v0 t + g t^2 / 2 + integral of the specific force, turned as the lidar turned,
/// give velocity and gravity, whose length must be gravity's.
/// \param sightings  without a break, oldest first  \param p_lidar_imu  the IMU from the lidar [m]
StartVerdict find_start(std::span<const Sighting> sightings, const ImuReadings& imu,
                        const Eigen::Vector3d& p_lidar_imu, const InertialOdometryOptions& options);

}  // namespace traverse::fusion
