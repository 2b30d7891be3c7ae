#include "imu_readings.hpp"

#include <algorithm>

#include "traverse/inertial/interpolated_reading.hpp"

namespace traverse::fusion {

using geometry::seconds_between;
using geometry::Stamp;
using sensors::ImuSample;

namespace {

bool is_before(const ImuSample& reading, Stamp stamp) { return reading.stamp < stamp; }

}  // namespace

void ImuReadings::add(const ImuSample& reading) {
  const bool is_finite = reading.angular_rate.allFinite() && reading.specific_force.allFinite();
  if (!is_finite || (!readings_.empty() && reading.stamp <= readings_.back().stamp)) {
    ++left_out_;
    return;
  }
  readings_.push_back(reading);
}

bool ImuReadings::reach(Stamp stamp) const {
  return !readings_.empty() && readings_.back().stamp >= stamp;
}

ImuSample ImuReadings::at(Stamp stamp) const {
  const auto after = std::lower_bound(readings_.begin(), readings_.end(), stamp, is_before);
  if (after != readings_.begin() && after != readings_.end()) {
    return inertial::interpolated(*(after - 1), *after, stamp);
  }
  ImuSample nearest = after == readings_.end() ? readings_.back() : readings_.front();
  nearest.stamp = stamp;
  return nearest;
}

std::vector<ImuSample> ImuReadings::between(Stamp from, Stamp to) const {
  std::vector<ImuSample> result{at(from)};
  auto next = std::lower_bound(readings_.begin(), readings_.end(), from, is_before);
  for (; next != readings_.end() && next->stamp < to; ++next) {
    if (next->stamp > from) result.push_back(*next);
  }
  result.push_back(at(to));
  return result;
}

double ImuReadings::longest_gap_s(Stamp from, Stamp to) const {
  double longest = 0;
  Stamp last = from;
  auto next = std::lower_bound(readings_.begin(), readings_.end(), from, is_before);
  if (next != readings_.begin()) last = (next - 1)->stamp;
  for (; next != readings_.end(); ++next) {
    longest = std::max(longest, seconds_between(last, next->stamp));
    last = next->stamp;
    if (last >= to) return longest;
  }
  return std::max(longest, seconds_between(last, to));
}

void ImuReadings::forget_before(Stamp stamp) {
  while (readings_.size() > 1 && readings_[1].stamp <= stamp) readings_.pop_front();
}

}  // namespace traverse::fusion
