#include "traverse/inertial/imu_noise.hpp"

namespace traverse::inertial {

void bind(config::Binder& b, ImuNoise& n) {
  using config::Range;
  b.number("gyro_density", n.gyro_density, Range::positive(),
           "white noise of the gyro, rad/s/sqrt(Hz)");
  b.number("accelerometer_density", n.accelerometer_density, Range::positive(),
           "white noise of the accelerometer, m/s^2/sqrt(Hz)");
  b.number("gyro_bias_walk", n.gyro_bias_walk, Range::positive(),
           "random walk of the gyro bias, rad/s/sqrt(s)");
  b.number("accelerometer_bias_walk", n.accelerometer_bias_walk, Range::positive(),
           "random walk of the accelerometer bias, m/s^2/sqrt(s)");
  b.flag("shaking", n.shaking,
         "take an IMU whose readings scatter by more than twice its white noise for as noisy");
}

}  // namespace traverse::inertial
