#pragma once

#include <Eigen/Core>

#include "traverse/geometry/pose3.hpp"
#include "traverse/inertial/nav_state.hpp"
#include "traverse/inertial/preintegration.hpp"

/// What navigation makes small, each one pure function of one or two states, with its derivative in
/// the states' tangent on request. None is divided by its standard deviation yet.
///
/// Sources: Forster et al., T-RO 2017, eqs. 45 and 67-74 (inertial); Gao Xiang, "SLAM in autonomous
/// driving", eqs. 4.38-4.48 and chapter 4's GNSS pose and encoder velocity (the book's forms).
namespace traverse::inertial {

template <int N>
using Residual = Eigen::Matrix<double, N, 1>;
template <int N>
using Jacobian = Eigen::Matrix<double, N, NavState::kTangent>;

/// (rotation, velocity, position) of the motion from i to j less what the IMU measured
/// [rad, m/s, m].
Residual<9> inertial_residual(const Preintegration& imu, const Eigen::Vector3d& gravity_map,
                              const NavState& i, const NavState& j, Jacobian<9>* dr_di = nullptr,
                              Jacobian<9>* dr_dj = nullptr);

/// What two states differ by in a part that only walks.
Residual<3> gyro_bias_walk_residual(const NavState& i, const NavState& j,
                                    Jacobian<3>* dr_di = nullptr, Jacobian<3>* dr_dj = nullptr);
Residual<3> accelerometer_bias_walk_residual(const NavState& i, const NavState& j,
                                             Jacobian<3>* dr_di = nullptr,
                                             Jacobian<3>* dr_dj = nullptr);
Residual<1> wheel_scale_walk_residual(const NavState& i, const NavState& j,
                                      Jacobian<1>* dr_di = nullptr, Jacobian<1>* dr_dj = nullptr);
Residual<2> wheel_turn_walk_residual(const NavState& i, const NavState& j,
                                     Jacobian<2>* dr_di = nullptr, Jacobian<2>* dr_dj = nullptr);
Residual<1> gnss_latency_walk_residual(const NavState& i, const NavState& j,
                                       Jacobian<1>* dr_di = nullptr, Jacobian<1>* dr_dj = nullptr);
/// A first-order Gauss-Markov process. \param decay  share of the bias of i that is left in j
Residual<3> gnss_bias_walk_residual(double decay, const NavState& i, const NavState& j,
                                    Jacobian<3>* dr_di = nullptr, Jacobian<3>* dr_dj = nullptr);

/// x less the state `expected`, in the tangent of `expected`.
Residual<NavState::kTangent> prior_residual(const NavState& expected, const NavState& x,
                                            Jacobian<NavState::kTangent>* dr_dx = nullptr);

/// A fix of an antenna on a moving body.
struct AntennaFix {
  Eigen::Vector3d p_map;                                       ///< measured [m]
  Eigen::Vector3d lever_body;                                  ///< of the antenna, body frame [m]
  Eigen::Vector3d angular_rate = Eigen::Vector3d::Zero();      ///< as the IMU read it [rad/s]
  Eigen::Vector3d acceleration_map = Eigen::Vector3d::Zero();  ///< as predicted [m/s^2]
};

/// Where the antenna was at the state's latency before it, to second order in time, with the bias
/// of fixes, less where it was measured, map frame [m].
Residual<3> gnss_position_residual(const AntennaFix& fix, const NavState& x,
                                   Jacobian<3>* dr_dx = nullptr);

/// The heading of the body's x axis less the one measured, wrapped to (-pi, pi] [rad], from the
/// map's x axis counterclockwise. Undefined when the x axis is vertical: derivative and value are
/// then zero.
Residual<1> heading_residual(double heading, const NavState& x, Jacobian<1>* dr_dx = nullptr);

/// Where the wheels' velocity is measured and in which axes.
struct WheelMount {
  Eigen::Matrix3d R_wheels_body = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();  ///< middle of the rear axle, in the body [m]
};

/// The velocity at the wheels less scale * (forward, 0, 0), in the wheels' axes as the state turns
/// them [m/s]: what they tell forward, and that they slip neither sideways nor off the ground.
/// \param angular_rate  as the IMU read it [rad/s], to carry the velocity over the lever arm
Residual<3> wheel_velocity_residual(double forward_mps, const WheelMount& mount,
                                    const Eigen::Vector3d& angular_rate, const NavState& x,
                                    Jacobian<3>* dr_dx = nullptr);

/// Standing still: velocity [m/s], then angular rate less bias [rad/s].
Residual<6> zero_velocity_residual(const Eigen::Vector3d& angular_rate, const NavState& x,
                                   Jacobian<6>* dr_dx = nullptr);

/// The book's GNSS pose: (Log(R_measured' R), p - p_measured) [rad, m]. It levels a vehicle that
/// stands on a slope, because a heading is given as a whole rotation.
Residual<6> gnss_pose_residual(const geometry::Pose3& T_map_body_measured, const NavState& x,
                               Jacobian<6>* dr_dx = nullptr);

/// The book's encoder: v - v_measured in the map frame [m/s], v_measured turned there once with the
/// attitude that was predicted.
Residual<3> world_velocity_residual(const Eigen::Vector3d& v_map_measured, const NavState& x,
                                    Jacobian<3>* dr_dx = nullptr);

}  // namespace traverse::inertial
