#include "traverse/simulation/imu_simulator.hpp"

#include <cmath>
#include <numbers>

namespace traverse::simulation {

using config::Range;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Which numbers of the noise are for what; samples use 0 .. 5 with their own number.
enum Use : std::uint32_t { kWhite = 0, kWalk = 3, kConstant = 6, kShaking = 9 };

/// Three pairs of independent numbers.
struct Pair {
  Vector3d gyro, accel;
};

Pair draw(const CounterNoise& noise, std::uint64_t major, std::uint32_t use) {
  Pair pair;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const CounterNoise::Draw d = noise.at(major, use + axis);
    pair.gyro[axis] = d.gaussian_1;
    pair.accel[axis] = d.gaussian_2;
  }
  return pair;
}

}  // namespace

void bind(config::Binder& b, ImuSettings& s) {
  b.flag("mounted", s.mounted, "the vehicle has an IMU");
  bind(b, s.mounting);
  b.number("rate_hz", s.rate_hz, Range::between(1, 2000), "samples per second");
  b.number("gyro_noise", s.gyro_noise, Range::non_negative(), "density, rad/s/sqrt(Hz)");
  b.number("accel_noise", s.accel_noise, Range::non_negative(), "density, m/s^2/sqrt(Hz)");
  b.number("gyro_bias_walk", s.gyro_bias_walk, Range::non_negative(), "density, rad/s^2/sqrt(Hz)");
  b.number("accel_bias_walk", s.accel_bias_walk, Range::non_negative(), "density, m/s^3/sqrt(Hz)");
  b.number("gyro_bias", s.gyro_bias, Range::non_negative(),
           "standard deviation at switch-on, rad/s");
  b.number("accel_bias", s.accel_bias, Range::non_negative(),
           "standard deviation at switch-on, m/s^2");
  b.number("scale_error", s.scale_error, Range::between(0, 0.1), "standard deviation, each axis");
  b.number("misalignment_deg", s.misalignment_deg, Range::between(0, 10),
           "standard deviation, each pair of axes");
  b.number("shaking_mps2", s.shaking_mps2, Range::non_negative(),
           "standard deviation of each reading while the vehicle drives, m/s^2");
  b.number("shaking_rads", s.shaking_rads, Range::non_negative(),
           "standard deviation of each reading while the vehicle drives, rad/s");
}

ImuSimulator::ImuSimulator(const ImuSettings& settings, const VehicleMotion& motion,
                           std::uint64_t seed)
    : settings_(settings),
      motion_(motion),
      T_body_imu_(settings.mounting.T_body_sensor()),
      noise_(seed, 2) {
  const double misalignment = settings.misalignment_deg * std::numbers::pi / 180;
  const auto matrix = [&](bool gyro) {
    Matrix3d m = Matrix3d::Identity();
    for (std::uint32_t row = 0; row < 3; ++row) {
      const Pair numbers = draw(noise_, row, kConstant);
      const Vector3d& of_row = gyro ? numbers.gyro : numbers.accel;
      for (int column = 0; column < 3; ++column) {
        const bool is_scale = static_cast<int>(row) == column;
        m(static_cast<int>(row), column) +=
            of_row[column] * (is_scale ? settings.scale_error : misalignment);
      }
    }
    return m;
  };
  const Pair bias = draw(noise_, 3, kConstant);
  calibration_ = {matrix(true), matrix(false), settings.gyro_bias * bias.gyro,
                  settings.accel_bias * bias.accel};
}

sensors::ImuSample ImuSimulator::exact(double seconds) const {
  const MotionState imu = motion_.state(seconds).at(T_body_imu_);
  sensors::ImuSample sample;
  sample.stamp = geometry::Stamp::from_seconds(seconds);
  sample.angular_rate = imu.angular_rate_body;
  sample.specific_force =
      imu.T_map_body.rotation.transpose() * (imu.acceleration_map + Vector3d(0, 0, kGravity));
  return sample;
}

sensors::ImuSample ImuSimulator::sample(std::size_t i) {
  sensors::ImuSample sample = exact(static_cast<double>(i) / settings_.rate_hz);
  const Pair white = draw(noise_, i, kWhite);
  const Pair step = draw(noise_, i, kWalk);
  const double per_sample = std::sqrt(settings_.rate_hz);
  sample.angular_rate = calibration_.gyro_matrix * sample.angular_rate + calibration_.gyro_bias +
                        gyro_walk_ + settings_.gyro_noise * per_sample * white.gyro;
  sample.specific_force = calibration_.accel_matrix * sample.specific_force +
                          calibration_.accel_bias + accel_walk_ +
                          settings_.accel_noise * per_sample * white.accel;
  const bool shakes = settings_.shaking_mps2 > 0 || settings_.shaking_rads > 0;
  constexpr double kDrives_mps = 0.05;
  if (shakes &&
      motion_.state(static_cast<double>(i) / settings_.rate_hz).velocity_map.norm() > kDrives_mps) {
    const Pair shaking = draw(noise_, i, kShaking);
    sample.angular_rate += settings_.shaking_rads * shaking.gyro;
    sample.specific_force += settings_.shaking_mps2 * shaking.accel;
  }
  gyro_walk_ += settings_.gyro_bias_walk / per_sample * step.gyro;
  accel_walk_ += settings_.accel_bias_walk / per_sample * step.accel;
  return sample;
}

}  // namespace traverse::simulation
