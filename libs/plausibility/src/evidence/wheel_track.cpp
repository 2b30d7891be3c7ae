#include "evidence/wheel_track.hpp"

#include <cmath>

#include "traverse/geometry/so3.hpp"

namespace traverse::plausibility {

namespace {

double metres(const sensors::WheelOdometry::Ticks& ticks, const sensors::WheelEncoder& encoder) {
  return (static_cast<double>(ticks.left) * encoder.left_m_per_pulse +
          static_cast<double>(ticks.right) * encoder.right_m_per_pulse) /
         2;
}

}  // namespace

void WheelTrack::take(double t, const sensors::WheelOdometry& reading,
                      const std::optional<sensors::WheelEncoder>& encoder) {
  constexpr double kGap_s = 1;
  if (!last_t_) {
    distance_.add(t, Eigen::Vector3d::Zero(), false);
    turn_.add(t, Accumulated<1>::Vector::Zero(), false);
  } else {
    const double dt = t - *last_t_;
    const auto way = advance(reading, dt, encoder.value_or(sensors::WheelEncoder{}));
    distance_.add(t, way.value_or(Eigen::Vector3d::Zero()), dt > kGap_s || !way);
    if (reading.velocity) {
      const double rate = last_.velocity
                              ? (last_.velocity->yaw_rate + reading.velocity->yaw_rate) / 2
                              : reading.velocity->yaw_rate;
      turn_.add(t, Accumulated<1>::Vector(dt * rate), dt > kGap_s);
    } else if (reading.T_odom_body && last_.T_odom_body) {
      const Eigen::Matrix3d R =
          last_.T_odom_body->rotation.transpose() * reading.T_odom_body->rotation;
      turn_.add(t, Accumulated<1>::Vector(geometry::log_so3(R).z()), dt > kGap_s);
    }
  }
  last_t_ = t;
  last_ = reading;
}

/// The same choice among what a reading holds as navigation makes: speeds before pulses before
/// dead-reckoned poses.
std::optional<Eigen::Vector3d> WheelTrack::advance(const sensors::WheelOdometry& reading, double dt,
                                                   const sensors::WheelEncoder& encoder) {
  if (reading.velocity && last_.velocity) {
    return Eigen::Vector3d::Constant(dt / 2 *
                                     (last_.velocity->forward_mps + reading.velocity->forward_mps));
  }
  if (reading.ticks && last_.ticks && encoder.left_m_per_pulse > 0) {
    has_pulses_ = true;
    const double sum = metres(*reading.ticks, encoder);
    const double count = sum - metres(*last_.ticks, encoder);
    const double difference = last_count_m_ ? count - *last_count_m_ : 0;
    last_count_m_ = count;
    return Eigen::Vector3d(count, difference, sum);
  }
  if (reading.T_odom_body && last_.T_odom_body) {
    const Eigen::Vector3d step =
        last_.T_odom_body->rotation.transpose() *
        (reading.T_odom_body->translation - last_.T_odom_body->translation);
    return Eigen::Vector3d::Constant(step.x());
  }
  return std::nullopt;
}

}  // namespace traverse::plausibility
