#include "factors/imu_shaking.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::inertial {

using geometry::seconds_between;

void ImuShaking::add(const sensors::ImuSample& sample) {
  constexpr std::size_t kReadings = 50;    // 150 values: their rms is good for a twelfth
  constexpr double kGap = 0.06;            // s
  constexpr double kUneven = 0.25;         // of the interval; a line through uneven points is none
  constexpr double kVarianceOfSecond = 6;  // 1 + 4 + 1
  constexpr double kExcess = 2;
  if (!noise_.shaking) return;
  last_.push_back(sample);
  if (last_.size() > 3) last_.pop_front();
  if (last_.size() < 3) return;
  const double before = seconds_between(last_[0].stamp, last_[1].stamp);
  const double after = seconds_between(last_[1].stamp, last_[2].stamp);
  const bool is_even = before > 0 && after < kGap && std::abs(after - before) < kUneven * after;
  if (!is_even) return;
  const auto second = [&](const auto& value) {
    const Eigen::Vector3d d = value(last_[0]) - 2 * value(last_[1]) + value(last_[2]);
    return d.squaredNorm() / (3 * kVarianceOfSecond);
  };
  const Squares found{second([](const auto& s) { return s.angular_rate; }),
                      second([](const auto& s) { return s.specific_force; }), after};
  squares_.push_back(found);
  if (squares_.size() > kReadings) squares_.pop_front();
  if (squares_.size() < kReadings) return;
  Squares sum;
  for (const Squares& one : squares_) {
    sum.gyro += one.gyro;
    sum.accelerometer += one.accelerometer;
    sum.seconds += one.seconds;
  }
  const auto n = static_cast<double>(kReadings);
  const auto density = [&](double squares, double told) {
    const double value = std::sqrt(squares / n * sum.seconds / n);
    return value > kExcess * told ? value : 0.0;
  };
  now_ = {density(sum.gyro, noise_.gyro_density),
          density(sum.accelerometer, noise_.accelerometer_density)};
  if (now_.gyro == 0 && now_.accelerometer == 0) return;
  if (!most_) most_ = {noise_.gyro_density, noise_.accelerometer_density};
  most_->gyro = std::max(most_->gyro, now_.gyro);
  most_->accelerometer = std::max(most_->accelerometer, now_.accelerometer);
}

Preintegration::NoiseScale ImuShaking::scale() const {
  return {std::max(1.0, now_.gyro / noise_.gyro_density),
          std::max(1.0, now_.accelerometer / noise_.accelerometer_density)};
}

}  // namespace traverse::inertial
