#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "traverse/geometry/pose3.hpp"
#include "traverse/geometry/stamp.hpp"

namespace traverse::inertial {

/// Where a vehicle is, how it moves, and how its sensors err, at one moment. The body is the IMU's
/// frame; the map has z up, and x east where the recording has GNSS.
struct NavState {
  static constexpr int kTangent = 22;
  using Tangent = Eigen::Matrix<double, kTangent, 1>;
  using Matrix = Eigen::Matrix<double, kTangent, kTangent>;

  /// Where each part begins in a Tangent and in the columns of a Jacobian.
  enum Part : int {
    kRotation = 0,  ///< [3] rad, on the right: R Exp(d)
    kPosition = 3,  ///< [3] m, added in the map frame
    kVelocity = 6,  ///< [3] m/s, added in the map frame
    kGyroBias = 9,
    kAccelerometerBias = 12,
    kWheelScale = 15,
    kWheelTurn = 16,  ///< [2] rad
    kGnssLatency = 18,
    kGnssBias = 19  ///< [3] m, map frame
  };

  geometry::Stamp stamp;
  Eigen::Quaterniond q_map_body = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();               ///< m
  Eigen::Vector3d v_map = Eigen::Vector3d::Zero();               ///< m/s
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();           ///< rad/s
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  ///< m/s^2
  double wheel_scale = 1;  ///< true distance = scale * what the wheels tell
  /// Pitch and yaw of the wheels' axes from where they are told to be, a rotation vector [rad].
  Eigen::Vector2d wheel_turn = Eigen::Vector2d::Zero();
  double gnss_latency = 0;  ///< a fix tells where the antenna was so long before its stamp [s]
  /// What fixes err by for seconds on end, map frame [m].
  Eigen::Vector3d gnss_bias = Eigen::Vector3d::Zero();

  Eigen::Matrix3d rotation() const { return q_map_body.toRotationMatrix(); }
  geometry::Pose3 T_map_body() const { return {rotation(), p_map}; }

  /// This state moved by `d`: the perturbation of all Jacobians here. The stamp stays.
  NavState plus(const Tangent& d) const;
  /// The d for which origin.plus(d) is this state.
  Tangent minus(const NavState& origin) const;
};

}  // namespace traverse::inertial
