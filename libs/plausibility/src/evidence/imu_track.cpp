#include "evidence/imu_track.hpp"

#include "traverse/statistics/quantile.hpp"

namespace traverse::plausibility {

void ImuTrack::take(double t, const sensors::ImuSample& sample) {
  constexpr double kGap_s = 0.5;  // five readings of the slowest units (KITTI's 10 Hz)
  constexpr std::size_t kIntervalsKept = 512;
  ++samples_;
  const double dt = last_t_ ? t - *last_t_ : 0;
  const bool is_gap = dt > kGap_s;
  if (last_t_ && intervals_.size() < kIntervalsKept) intervals_.push_back(dt);
  turn_.add(t, dt / 2 * (last_.angular_rate + sample.angular_rate), is_gap);
  push_.add(t, dt / 2 * (last_.specific_force + sample.specific_force), is_gap);
  last_t_ = t;
  last_ = sample;
}

std::optional<double> ImuTrack::interval_s() const {
  if (intervals_.size() < 2) return std::nullopt;
  return statistics::median(intervals_);
}

}  // namespace traverse::plausibility
