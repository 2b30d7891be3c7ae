#include "traverse/loam/imu_prediction.hpp"

#include <algorithm>

#include "traverse/geometry/so3.hpp"

namespace traverse::loam {

namespace {

/// The angular rate at `stamp` between two samples.
Eigen::Vector3d rate_at(const sensors::ImuSample& before, const sensors::ImuSample& after,
                        geometry::Stamp stamp) {
  const double s = geometry::seconds_between(before.stamp, stamp) /
                   geometry::seconds_between(before.stamp, after.stamp);
  return (1 - s) * before.angular_rate + s * after.angular_rate;
}

}  // namespace

void bind(config::Binder& b, ImuOptions& o) {
  using config::Range;
  b.flag("use", o.use, "predict rotations from the recording's IMU, if there is one");
  b.number("longest_gap_s", o.longest_gap_s, Range::positive(),
           "longest gap between samples that is bridged; beyond it, constant velocity");
}

ImuPrediction::ImuPrediction(const ImuOptions& options) : options_(options) {}

void ImuPrediction::observe(const sensors::ImuSample& sample_lidar) {
  if (!options_.use || !sample_lidar.angular_rate.allFinite()) return;
  if (!samples_.empty() && sample_lidar.stamp <= samples_.back().stamp) return;
  samples_.push_back(sample_lidar);
}

std::optional<Eigen::Vector3d> ImuPrediction::rotation(geometry::Stamp from,
                                                       geometry::Stamp to) const {
  if (samples_.empty() || from > to) return std::nullopt;
  const auto is_gap = [&](geometry::Stamp earlier, geometry::Stamp later) {
    return geometry::seconds_between(earlier, later) > options_.longest_gap_s;
  };
  if (is_gap(from, samples_.front().stamp) || is_gap(samples_.back().stamp, to)) {
    return std::nullopt;
  }
  Eigen::Matrix3d R_from_now = Eigen::Matrix3d::Identity();
  const auto turn = [&](geometry::Stamp begin, geometry::Stamp end, const Eigen::Vector3d& rate) {
    if (begin < end) R_from_now *= geometry::exp_so3(geometry::seconds_between(begin, end) * rate);
  };
  const auto& first = samples_.front();
  const auto& last = samples_.back();
  turn(from, std::min(to, first.stamp), first.angular_rate);
  for (std::size_t i = 1; i < samples_.size(); ++i) {
    const auto& before = samples_[i - 1];
    const auto& after = samples_[i];
    const geometry::Stamp begin = std::max(from, before.stamp);
    const geometry::Stamp end = std::min(to, after.stamp);
    if (begin >= end) continue;
    if (is_gap(before.stamp, after.stamp)) return std::nullopt;
    turn(begin, end, 0.5 * (rate_at(before, after, begin) + rate_at(before, after, end)));
  }
  turn(std::max(from, last.stamp), to, last.angular_rate);
  return geometry::log_so3(R_from_now);
}

void ImuPrediction::forget_before(geometry::Stamp stamp) {
  while (samples_.size() > 1 && samples_[1].stamp <= stamp) samples_.pop_front();
}

}  // namespace traverse::loam
