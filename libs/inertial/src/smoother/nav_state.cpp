#include "traverse/inertial/nav_state.hpp"

#include "traverse/geometry/so3.hpp"

namespace traverse::inertial {

NavState NavState::plus(const Tangent& d) const {
  NavState moved = *this;
  moved.q_map_body = (q_map_body * geometry::exp_quaternion(d.segment<3>(kRotation))).normalized();
  moved.p_map += d.segment<3>(kPosition);
  moved.v_map += d.segment<3>(kVelocity);
  moved.gyro_bias += d.segment<3>(kGyroBias);
  moved.accelerometer_bias += d.segment<3>(kAccelerometerBias);
  moved.wheel_scale += d[kWheelScale];
  moved.wheel_turn += d.segment<2>(kWheelTurn);
  moved.gnss_latency += d[kGnssLatency];
  moved.gnss_bias += d.segment<3>(kGnssBias);
  return moved;
}

NavState::Tangent NavState::minus(const NavState& origin) const {
  Tangent d;
  d.segment<3>(kRotation) = geometry::log_quaternion(origin.q_map_body.conjugate() * q_map_body);
  d.segment<3>(kPosition) = p_map - origin.p_map;
  d.segment<3>(kVelocity) = v_map - origin.v_map;
  d.segment<3>(kGyroBias) = gyro_bias - origin.gyro_bias;
  d.segment<3>(kAccelerometerBias) = accelerometer_bias - origin.accelerometer_bias;
  d[kWheelScale] = wheel_scale - origin.wheel_scale;
  d.segment<2>(kWheelTurn) = wheel_turn - origin.wheel_turn;
  d[kGnssLatency] = gnss_latency - origin.gnss_latency;
  d.segment<3>(kGnssBias) = gnss_bias - origin.gnss_bias;
  return d;
}

}  // namespace traverse::inertial
