#include "traverse/pipeline/clock_offset.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "traverse/geometry/so3.hpp"
#include "traverse/statistics/quantile.hpp"

namespace traverse::pipeline {

namespace {

constexpr double kLeastCorrelation = 0.7;
constexpr double kLeastMargin = 0.1;
constexpr double kLeastOverlap = 0.5;      // of the shorter one
constexpr std::size_t kFewestPoses = 20;   // to correlate anything
constexpr std::size_t kMostCoarse = 2000;  // samples of the first look, which is over all lags
constexpr double kLeastSpread_rad_s = 1e-3;

/// The angle over time, and mean speeds of any piece of it.
class Turning {
 public:
  explicit Turning(const TurnedAngle& turned) : angle_(turned.angle_rad) {
    for (const geometry::Stamp stamp : turned.stamps) {
      seconds_.push_back(geometry::seconds_between(turned.stamps.front(), stamp));
    }
  }

  double span_s() const { return seconds_.back(); }

  double usual_interval_s() const {
    std::vector<double> intervals;
    for (std::size_t i = 1; i < seconds_.size(); ++i) {
      intervals.push_back(seconds_[i] - seconds_[i - 1]);
    }
    return statistics::median(intervals);
  }

  /// Mean angular speed over `width` from `begin` on, which must lie inside.
  double speed(double begin, double width) const {
    return (angle_at(begin + width) - angle_at(begin)) / width;
  }

 private:
  double angle_at(double second) const {
    const auto after = std::upper_bound(seconds_.begin(), seconds_.end(), second);
    if (after == seconds_.begin()) return angle_.front();
    if (after == seconds_.end()) return angle_.back();
    const auto i = static_cast<std::size_t>(after - seconds_.begin());
    const double share = (second - seconds_[i - 1]) / (seconds_[i] - seconds_[i - 1]);
    return angle_[i - 1] + share * (angle_[i] - angle_[i - 1]);
  }

  std::vector<double> seconds_;
  std::vector<double> angle_;
};

/// Pearson's correlation of the speeds where the second lags by `lag` seconds behind the first;
/// -1 where they overlap too little or do not turn.
double correlation_at(const Turning& first, const Turning& second, double lag, double width,
                      double step) {
  const double begin = std::max(0.0, -lag);
  const double end = std::min(first.span_s(), second.span_s() - lag) - width;
  const double least = kLeastOverlap * std::min(first.span_s(), second.span_s());
  if (end - begin < least || !(end > begin)) return -1;
  const auto count = static_cast<std::size_t>((end - begin) / step);
  double n = 0;
  double a = 0;
  double b = 0;
  double aa = 0;
  double bb = 0;
  double ab = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = begin + static_cast<double>(i) * step;
    const double u = first.speed(at, width);
    const double v = second.speed(at + lag, width);
    n += 1;
    a += u;
    b += v;
    aa += u * u;
    bb += v * v;
    ab += u * v;
  }
  if (n < static_cast<double>(kFewestPoses)) return -1;
  const double var_a = aa / n - (a / n) * (a / n);
  const double var_b = bb / n - (b / n) * (b / n);
  const double least_variance = kLeastSpread_rad_s * kLeastSpread_rad_s;
  if (!(var_a > least_variance && var_b > least_variance)) return -1;
  return (ab / n - (a / n) * (b / n)) / std::sqrt(var_a * var_b);
}

struct Peak {
  double lag = 0;
  double value = -1;
};

/// The highest of all lags a step apart, and the highest maximum apart from it.
std::pair<Peak, Peak> highest(const Turning& first, const Turning& second, double width,
                              double step) {
  std::vector<Peak> all;
  const auto count = static_cast<std::size_t>((first.span_s() + second.span_s()) / step) + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double lag = -first.span_s() + static_cast<double>(i) * step;
    all.push_back(Peak{lag, correlation_at(first, second, lag, width, step)});
  }
  const auto by_value = [](const Peak& x, const Peak& y) { return x.value < y.value; };
  const Peak best = *std::max_element(all.begin(), all.end(), by_value);
  Peak other;
  for (std::size_t i = 1; i + 1 < all.size(); ++i) {
    const bool is_peak = all[i].value >= all[i - 1].value && all[i].value >= all[i + 1].value;
    const bool is_apart = std::abs(all[i].lag - best.lag) > 3 * step;
    if (is_peak && is_apart && by_value(other, all[i])) other = all[i];
  }
  return {best, other};
}

}  // namespace

TurnedAngle TurnedAngle::of(const geometry::Trajectory& T_map_body) {
  TurnedAngle turned;
  double angle = 0;
  for (std::size_t i = 0; i < T_map_body.size(); ++i) {
    if (i > 0) {
      if (T_map_body.stamp(i) <= turned.stamps.back()) continue;
      angle += geometry::angle_of(T_map_body.pose(i - 1).rotation.transpose() *
                                  T_map_body.pose(i).rotation);
    }
    turned.stamps.push_back(T_map_body.stamp(i));
    turned.angle_rad.push_back(angle);
  }
  return turned;
}

TurnedAngle TurnedAngle::of(const std::vector<sensors::ImuSample>& samples) {
  TurnedAngle turned;
  double angle = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i > 0) {
      if (samples[i].stamp <= turned.stamps.back()) continue;
      angle += samples[i].angular_rate.norm() *
               geometry::seconds_between(turned.stamps.back(), samples[i].stamp);
    }
    turned.stamps.push_back(samples[i].stamp);
    turned.angle_rad.push_back(angle);
  }
  return turned;
}

std::optional<ClockOffset> find_clock_offset(const TurnedAngle& first, const TurnedAngle& second) {
  if (first.stamps.size() < kFewestPoses || second.stamps.size() < kFewestPoses) {
    return std::nullopt;
  }
  const Turning a(first);
  const Turning b(second);
  const double width = std::max(a.usual_interval_s(), b.usual_interval_s());
  if (!(width > 0)) return std::nullopt;
  double step =
      std::max(width, std::max(a.span_s(), b.span_s()) / static_cast<double>(kMostCoarse));
  auto [best, other] = highest(a, b, std::max(width, step), step);
  if (best.value < kLeastCorrelation || other.value > best.value - kLeastMargin) {
    return std::nullopt;
  }
  while (step > width / 64) {
    step /= 2;
    const double window = std::max(width, step);
    Peak finer = best;
    finer.value = correlation_at(a, b, best.lag, window, window);
    for (const double lag : {best.lag - step, best.lag + step}) {
      const double value = correlation_at(a, b, lag, window, window);
      if (value > finer.value) finer = Peak{lag, value};
    }
    best = finer;
  }
  if (best.value < kLeastCorrelation) return std::nullopt;
  const double begins_s = geometry::seconds_between(first.stamps.front(), second.stamps.front());
  return ClockOffset{begins_s + best.lag, best.value, other.value};
}

}  // namespace traverse::pipeline
