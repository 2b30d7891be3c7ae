#include "navigation/heading_scatter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace traverse::inertial {

using geometry::seconds_between;

void HeadingScatter::add(const sensors::ImuSample& sample) {
  if (last_imu_) {
    const double rate = 0.5 * (last_imu_->angular_rate.z() + sample.angular_rate.z());
    turn_ += rate * seconds_between(last_imu_->stamp, sample.stamp);
  }
  last_imu_ = sample;
}

void HeadingScatter::add(geometry::Stamp stamp, double heading) {
  constexpr std::size_t kMost = 100;
  constexpr double kLongest = 1;  // s, in which a gyro's bias is no part of the scatter
  if (last_ && seconds_between(last_->stamp, stamp) <= kLongest) {
    const double change = heading - last_->heading - (turn_ - last_->turn);
    differences_.push_back(std::abs(std::remainder(change, 2 * std::numbers::pi)) /
                           std::numbers::sqrt2);
    if (differences_.size() > kMost) differences_.pop_front();
  }
  last_ = {stamp, heading, turn_};
}

void HeadingScatter::forget_turn() {
  last_imu_.reset();
  last_.reset();
}

double HeadingScatter::sigma(double told) const {
  constexpr std::size_t kLeast = 20;
  constexpr double kMedianOfNormal = 0.6745;  // of |x|, standard deviation 1
  constexpr double kOutlier = 4;              // deviations
  constexpr int kRounds = 4;
  constexpr double kExcess = 1.5;
  if (differences_.size() < kLeast) return told;
  std::vector<double> values(differences_.begin(), differences_.end());
  double found = 0;
  // The median without those that are far beyond it, until it stays: up to half may be wrong.
  for (int round = 0; round < kRounds; ++round) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    found = *middle / kMedianOfNormal;
    std::erase_if(values, [&](double value) { return value > kOutlier * found; });
    if (values.size() < kLeast / 2) return told;
  }
  return found > kExcess * told ? found : told;
}

}  // namespace traverse::inertial
