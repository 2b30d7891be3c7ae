#include "factors/imu_link.hpp"

#include <algorithm>
#include <cmath>

#include "traverse/geometry/so3.hpp"

namespace traverse::inertial {

using geometry::seconds_between;
using sensors::ImuSample;

ImuSample interpolated(const ImuSample& before, const ImuSample& after, geometry::Stamp stamp) {
  const double span = seconds_between(before.stamp, after.stamp);
  const double share = span > 0 ? seconds_between(before.stamp, stamp) / span : 1;
  ImuSample sample = before;
  sample.stamp = stamp;
  sample.angular_rate += share * (after.angular_rate - before.angular_rate);
  sample.specific_force += share * (after.specific_force - before.specific_force);
  return sample;
}

ImuLink::ImuLink(const ImuLink& other)
    : noise_(other.noise_),
      shaking_(other.shaking_),
      imu_(other.imu_ ? std::make_shared<Preintegration>(*other.imu_) : nullptr),
      last_(other.last_),
      forward_mps_(other.forward_mps_),
      v_map_(other.v_map_),
      q_map_body_(other.q_map_body_) {}

void ImuLink::begin(const NavState& state) {
  imu_ = std::make_shared<Preintegration>(noise_, state.gyro_bias, state.accelerometer_bias);
  forward_mps_ = (state.q_map_body.conjugate() * state.v_map).x();
  v_map_ = state.v_map;
  q_map_body_ = state.q_map_body;
}

ImuLink::Step ImuLink::add(const ImuSample& sample, const NavState& newest,
                           const Eigen::Vector3d& gravity_map) {
  constexpr double kGap = 0.06;     // s; longer is not a rate that an IMU has
  constexpr double kGapNoise = 30;  // what happened in it is hardly known
  constexpr double kPiece = 0.01;
  constexpr double kMostPieces = 1e5;  // of a quarter of an hour; a clock may be centuries off
  const double seconds = seconds_between(last_->stamp, sample.stamp);
  const Eigen::Vector3d rate = 0.5 * (last_->angular_rate + sample.angular_rate);
  // The later reading is in axes that have turned: brought back, the mean is the trapezoidal rule
  // on R a, of second order, where the mean of the readings as they are is of first.
  const Eigen::Vector3d turn = (rate - imu_->gyro_bias()) * seconds;
  const Eigen::Vector3d force =
      0.5 * (last_->specific_force + geometry::exp_so3(turn) * sample.specific_force);
  Step step;
  step.is_gap = seconds > kGap;
  const int pieces =
      step.is_gap ? static_cast<int>(std::min(std::ceil(seconds / kPiece), kMostPieces)) : 1;
  Preintegration::NoiseScale noise = shaking_.scale();
  if (step.is_gap) noise = {kGapNoise * noise.gyro, kGapNoise * noise.accelerometer};
  for (int k = 0; k < pieces; ++k) imu_->add(rate, force, seconds / pieces, noise);
  const NavState moved = imu_->predict(newest, gravity_map);
  const double forward = (moved.q_map_body.conjugate() * moved.v_map).x();
  // The speed's change within this step alone: solutions in between move the speed itself.
  step.speed_change_mps = forward - forward_mps_;
  step.way_m = moved.v_map.norm() * seconds;
  step.seconds = seconds;
  step.velocity_change_map = moved.v_map - v_map_;
  forward_mps_ = forward;
  v_map_ = moved.v_map;
  q_map_body_ = moved.q_map_body;
  last_ = sample;
  return step;
}

std::shared_ptr<Preintegration> ImuLink::take() {
  imu_->split_single_sample();
  return std::move(imu_);
}

Eigen::Vector3d ImuLink::acceleration(const NavState& state,
                                      const Eigen::Vector3d& gravity_map) const {
  return state.q_map_body * (last_->specific_force - state.accelerometer_bias) + gravity_map;
}

}  // namespace traverse::inertial
