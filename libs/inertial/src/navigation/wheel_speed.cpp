#include "navigation/wheel_speed.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::inertial {

using geometry::seconds_between;
using geometry::Stamp;

bool WheelSpeed::add(const sensors::WheelOdometry& reading) {
  constexpr double kMost = 200;  // m/s; beyond is a fault
  const std::optional<sensors::WheelOdometry> before = previous_;
  previous_ = reading;
  double mps = 0;
  if (reading.velocity) {
    mps = reading.velocity->forward_mps;
    is_instant_ = true;
  } else if (reading.ticks && before && before->ticks && encoder_) {
    const double seconds = seconds_between(before->stamp, reading.stamp);
    const double left = static_cast<double>(reading.ticks->left - before->ticks->left);
    const double right = static_cast<double>(reading.ticks->right - before->ticks->right);
    const double way =
        (left * encoder_->left_m_per_pulse + right * encoder_->right_m_per_pulse) / 2;
    if (!(seconds > 0)) return false;
    mps = way / seconds;
    if (!begin_ || seconds_between(*begin_, reading.stamp) > kOldest) {
      begin_ = before->stamp;
      distance_m_ = 0;
    }
    distance_m_ += way;
  } else {
    return false;
  }
  if (!std::isfinite(mps) || std::abs(mps) > kMost) {
    begin_.reset();
    distance_m_ = 0;
    return false;
  }
  mean_mps_ = mps;
  end_ = reading.stamp;
  if (std::abs(mps) > standing_mps_) {
    slow_since_.reset();
  } else if (!slow_since_) {
    slow_since_ = reading.stamp;
  }
  is_fresh_ = true;
  return true;
}

double WheelSpeed::standing_seconds() const {
  return slow_since_ ? seconds_between(*slow_since_, end_) : 0;
}

void WheelSpeed::add_change(Stamp stamp, double change_mps) {
  changes_.push_back({stamp, change_mps + (changes_.empty() ? 0 : changes_.back().sum_mps)});
  while (seconds_between(changes_.front().stamp, stamp) > 4 * kOldest) changes_.pop_front();
}

double WheelSpeed::change_at(Stamp stamp) const {
  if (changes_.empty()) return 0;
  const auto after = std::lower_bound(changes_.begin(), changes_.end(), stamp,
                                      [](const Change& c, Stamp s) { return c.stamp < s; });
  if (after == changes_.begin()) return after->sum_mps;
  if (after == changes_.end()) return changes_.back().sum_mps;
  const auto& before = *std::prev(after);
  const double span = seconds_between(before.stamp, after->stamp);
  const double share = span > 0 ? seconds_between(before.stamp, stamp) / span : 1;
  return before.sum_mps + share * (after->sum_mps - before.sum_mps);
}

double WheelSpeed::mean_change(Stamp from, Stamp to) const {
  constexpr int kPieces = 8;  // trapezoids
  const double seconds = seconds_between(from, to);
  double sum = 0;
  for (int k = 0; k <= kPieces; ++k) {
    const double weight = k == 0 || k == kPieces ? 0.5 : 1;
    sum += weight * change_at(geometry::shifted(from, seconds * k / kPieces));
  }
  return sum / kPieces;
}

std::optional<double> WheelSpeed::take(Stamp stamp) {
  taken_.reset();
  const bool is_usable = is_fresh_ && seconds_between(end_, stamp) < kOldest;
  if (!is_usable) return std::nullopt;
  is_fresh_ = false;
  if (is_instant_) {
    taken_ = {stamp, mean_mps_ + change_at(stamp) - change_at(end_)};
    return taken_->mps;
  }
  if (changes_.empty() || changes_.front().stamp > *begin_) return std::nullopt;
  const double mean = distance_m_ / seconds_between(*begin_, end_);
  const double speed = mean + change_at(stamp) - mean_change(*begin_, end_);
  begin_ = end_;
  distance_m_ = 0;
  taken_ = {stamp, speed};
  return speed;
}

std::optional<double> WheelSpeed::taken_at(Stamp stamp) const {
  const bool is_usable = taken_ && seconds_between(stamp, taken_->stamp) < kOldest &&
                         !changes_.empty() && changes_.front().stamp <= stamp;
  if (!is_usable) return std::nullopt;
  return taken_->mps + change_at(stamp) - change_at(taken_->stamp);
}

}  // namespace traverse::inertial
