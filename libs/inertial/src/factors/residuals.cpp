#include "traverse/inertial/residuals.hpp"

#include <cmath>
#include <numbers>

#include "traverse/geometry/so3.hpp"

namespace traverse::inertial {

using geometry::exp_so3;
using geometry::hat;
using geometry::left_jacobian_inverse;
using geometry::log_so3;
using geometry::right_jacobian;
using geometry::right_jacobian_inverse;

namespace {

/// r = part of j - part of i.
template <int N, int kPart>
void walk_jacobians(Jacobian<N>* dr_di, Jacobian<N>* dr_dj) {
  if (dr_di != nullptr) {
    dr_di->setZero();
    dr_di->template block<N, N>(0, kPart) = -Eigen::Matrix<double, N, N>::Identity();
  }
  if (dr_dj != nullptr) {
    dr_dj->setZero();
    dr_dj->template block<N, N>(0, kPart).setIdentity();
  }
}

}  // namespace

Residual<9> inertial_residual(const Preintegration& imu, const Eigen::Vector3d& gravity_map,
                              const NavState& i, const NavState& j, Jacobian<9>* dr_di,
                              Jacobian<9>* dr_dj) {
  using S = NavState;
  const double T = imu.seconds();
  const Preintegration::Increments measured = imu.at(i.gyro_bias, i.accelerometer_bias);
  const Eigen::Matrix3d Ri_t = i.rotation().transpose();
  const Eigen::Matrix3d Rj = j.rotation();
  const Eigen::Vector3d dv = Ri_t * (j.v_map - i.v_map - gravity_map * T);
  const Eigen::Vector3d dp = Ri_t * (j.p_map - i.p_map - i.v_map * T - 0.5 * T * T * gravity_map);

  Residual<9> r;
  const Eigen::Vector3d r_R = log_so3(measured.rotation.transpose() * Ri_t * Rj);
  r.segment<3>(0) = r_R;
  r.segment<3>(3) = dv - measured.velocity;
  r.segment<3>(6) = dp - measured.position;
  if (dr_di == nullptr && dr_dj == nullptr) return r;

  const Eigen::Matrix3d Jr_inverse = right_jacobian_inverse(r_R);
  if (dr_di != nullptr) {
    const Preintegration::BiasJacobians& d = imu.bias_jacobians();
    const Eigen::Vector3d shift = d.rotation_gyro * (i.gyro_bias - imu.gyro_bias());
    Jacobian<9>& J = *dr_di;
    J.setZero();
    J.block<3, 3>(0, S::kRotation) = -Jr_inverse * Rj.transpose() * Ri_t.transpose();  // 4.42
    // 4.45, where Jr^-1(r) Exp(r)' = Jl^-1(r).
    J.block<3, 3>(0, S::kGyroBias) =
        -left_jacobian_inverse(r_R) * right_jacobian(shift) * d.rotation_gyro;
    J.block<3, 3>(3, S::kRotation) = hat(dv);  // 4.47
    J.block<3, 3>(3, S::kVelocity) = -Ri_t;    // 4.46
    J.block<3, 3>(3, S::kGyroBias) = -d.velocity_gyro;
    J.block<3, 3>(3, S::kAccelerometerBias) = -d.velocity_accelerometer;
    J.block<3, 3>(6, S::kRotation) = hat(dp);  // 4.48
    J.block<3, 3>(6, S::kPosition) = -Ri_t;
    J.block<3, 3>(6, S::kVelocity) = -T * Ri_t;
    J.block<3, 3>(6, S::kGyroBias) = -d.position_gyro;
    J.block<3, 3>(6, S::kAccelerometerBias) = -d.position_accelerometer;
  }
  if (dr_dj != nullptr) {
    Jacobian<9>& J = *dr_dj;
    J.setZero();
    J.block<3, 3>(0, S::kRotation) = Jr_inverse;  // 4.43
    J.block<3, 3>(3, S::kVelocity) = Ri_t;        // 4.46
    J.block<3, 3>(6, S::kPosition) = Ri_t;
  }
  return r;
}

Residual<3> gyro_bias_walk_residual(const NavState& i, const NavState& j, Jacobian<3>* dr_di,
                                    Jacobian<3>* dr_dj) {
  walk_jacobians<3, NavState::kGyroBias>(dr_di, dr_dj);
  return j.gyro_bias - i.gyro_bias;
}

Residual<3> accelerometer_bias_walk_residual(const NavState& i, const NavState& j,
                                             Jacobian<3>* dr_di, Jacobian<3>* dr_dj) {
  walk_jacobians<3, NavState::kAccelerometerBias>(dr_di, dr_dj);
  return j.accelerometer_bias - i.accelerometer_bias;
}

Residual<1> wheel_scale_walk_residual(const NavState& i, const NavState& j, Jacobian<1>* dr_di,
                                      Jacobian<1>* dr_dj) {
  walk_jacobians<1, NavState::kWheelScale>(dr_di, dr_dj);
  return Residual<1>(j.wheel_scale - i.wheel_scale);
}

Residual<2> wheel_turn_walk_residual(const NavState& i, const NavState& j, Jacobian<2>* dr_di,
                                     Jacobian<2>* dr_dj) {
  walk_jacobians<2, NavState::kWheelTurn>(dr_di, dr_dj);
  return j.wheel_turn - i.wheel_turn;
}

Residual<1> gnss_latency_walk_residual(const NavState& i, const NavState& j, Jacobian<1>* dr_di,
                                       Jacobian<1>* dr_dj) {
  walk_jacobians<1, NavState::kGnssLatency>(dr_di, dr_dj);
  return Residual<1>(j.gnss_latency - i.gnss_latency);
}

Residual<3> gnss_bias_walk_residual(double decay, const NavState& i, const NavState& j,
                                    Jacobian<3>* dr_di, Jacobian<3>* dr_dj) {
  walk_jacobians<3, NavState::kGnssBias>(dr_di, dr_dj);
  if (dr_di != nullptr) *dr_di *= decay;
  return j.gnss_bias - decay * i.gnss_bias;
}

Residual<NavState::kTangent> prior_residual(const NavState& expected, const NavState& x,
                                            Jacobian<NavState::kTangent>* dr_dx) {
  const NavState::Tangent r = x.minus(expected);
  if (dr_dx != nullptr) {
    dr_dx->setIdentity();
    dr_dx->block<3, 3>(NavState::kRotation, NavState::kRotation) =
        right_jacobian_inverse(r.segment<3>(NavState::kRotation));
  }
  return r;
}

Residual<3> gnss_position_residual(const AntennaFix& fix, const NavState& x, Jacobian<3>* dr_dx) {
  const Eigen::Matrix3d R = x.rotation();
  const Eigen::Vector3d& l = fix.lever_body;
  const double t = x.gnss_latency;
  const Eigen::Vector3d swing = (fix.angular_rate - x.gyro_bias).cross(l);
  const Eigen::Vector3d v_antenna = x.v_map + R * swing;
  if (dr_dx != nullptr) {
    dr_dx->setZero();
    dr_dx->block<3, 3>(0, NavState::kRotation) = -R * hat(l - t * swing);
    dr_dx->block<3, 3>(0, NavState::kPosition).setIdentity();
    dr_dx->block<3, 3>(0, NavState::kVelocity) = -t * Eigen::Matrix3d::Identity();
    dr_dx->block<3, 3>(0, NavState::kGyroBias) = -t * R * hat(l);
    dr_dx->block<3, 3>(0, NavState::kGnssBias).setIdentity();
    dr_dx->col(NavState::kGnssLatency) = t * fix.acceleration_map - v_antenna;
  }
  return x.p_map + R * l - t * v_antenna + 0.5 * t * t * fix.acceleration_map + x.gnss_bias -
         fix.p_map;
}

Residual<1> heading_residual(double heading, const NavState& x, Jacobian<1>* dr_dx) {
  constexpr double kVertical = 1e-12;  // squared sine of the x axis from the vertical
  const Eigen::Matrix3d R = x.rotation();
  const double c = R(0, 0) * R(0, 0) + R(1, 0) * R(1, 0);
  if (dr_dx != nullptr) dr_dx->setZero();
  if (c < kVertical) return Residual<1>::Zero();
  if (dr_dx != nullptr) {
    (*dr_dx)(0, NavState::kRotation + 1) = -(R(0, 0) * R(1, 2) - R(1, 0) * R(0, 2)) / c;
    (*dr_dx)(0, NavState::kRotation + 2) = (R(0, 0) * R(1, 1) - R(1, 0) * R(0, 1)) / c;
  }
  const double difference = std::atan2(R(1, 0), R(0, 0)) - heading;
  return Residual<1>(std::remainder(difference, 2 * std::numbers::pi));
}

Residual<3> wheel_velocity_residual(double forward_mps, const WheelMount& mount,
                                    const Eigen::Vector3d& angular_rate, const NavState& x,
                                    Jacobian<3>* dr_dx) {
  const Eigen::Vector3d v_body = x.rotation().transpose() * x.v_map;
  const Eigen::Vector3d v_at_wheels = v_body + (angular_rate - x.gyro_bias).cross(mount.p_body);
  const Eigen::Vector3d told(forward_mps, 0, 0);
  const Eigen::Vector3d turn(0, x.wheel_turn[0], x.wheel_turn[1]);
  const Eigen::Matrix3d R_wheels_body = exp_so3(turn) * mount.R_wheels_body;
  const Eigen::Vector3d v_wheels = R_wheels_body * v_at_wheels;
  if (dr_dx != nullptr) {
    dr_dx->setZero();
    dr_dx->block<3, 3>(0, NavState::kRotation) = R_wheels_body * hat(v_body);
    dr_dx->block<3, 3>(0, NavState::kVelocity) = R_wheels_body * x.rotation().transpose();
    dr_dx->block<3, 3>(0, NavState::kGyroBias) = R_wheels_body * hat(mount.p_body);
    dr_dx->col(NavState::kWheelScale) = -told;
    // Exp(a + d) u = Exp(a) Exp(Jr(a) d) u
    dr_dx->block<3, 2>(0, NavState::kWheelTurn) =
        (-exp_so3(turn) * hat(mount.R_wheels_body * v_at_wheels) * right_jacobian(turn))
            .rightCols<2>();
  }
  return v_wheels - x.wheel_scale * told;
}

Residual<6> zero_velocity_residual(const Eigen::Vector3d& angular_rate, const NavState& x,
                                   Jacobian<6>* dr_dx) {
  Residual<6> r;
  r << x.v_map, angular_rate - x.gyro_bias;
  if (dr_dx != nullptr) {
    dr_dx->setZero();
    dr_dx->block<3, 3>(0, NavState::kVelocity).setIdentity();
    dr_dx->block<3, 3>(3, NavState::kGyroBias) = -Eigen::Matrix3d::Identity();
  }
  return r;
}

Residual<6> gnss_pose_residual(const geometry::Pose3& T_map_body_measured, const NavState& x,
                               Jacobian<6>* dr_dx) {
  Residual<6> r;
  r.head<3>() = log_so3(T_map_body_measured.rotation.transpose() * x.rotation());
  r.tail<3>() = x.p_map - T_map_body_measured.translation;
  if (dr_dx != nullptr) {
    dr_dx->setZero();
    dr_dx->block<3, 3>(0, NavState::kRotation) = right_jacobian_inverse(r.head<3>());
    dr_dx->block<3, 3>(3, NavState::kPosition).setIdentity();
  }
  return r;
}

Residual<3> world_velocity_residual(const Eigen::Vector3d& v_map_measured, const NavState& x,
                                    Jacobian<3>* dr_dx) {
  if (dr_dx != nullptr) {
    dr_dx->setZero();
    dr_dx->block<3, 3>(0, NavState::kVelocity).setIdentity();
  }
  return x.v_map - v_map_measured;
}

}  // namespace traverse::inertial
