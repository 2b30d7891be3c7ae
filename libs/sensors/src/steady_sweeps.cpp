#include "traverse/sensors/steady_sweeps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "traverse/sensors/sweep_timing.hpp"
#include "traverse/statistics/quantile.hpp"

namespace traverse::sensors {

namespace {

constexpr std::size_t kEnough = 3;          // intervals, to tell how they scatter
constexpr double kScatter = 0.03;           // of an interval; a head's speed is held to 1 %
constexpr double kContinuous = 0.25;        // of an interval: points that span one have no pause
constexpr double kMadToDeviation = 1.4826;  // of a normal distribution

template <typename Value>
void remember(Value value, std::size_t most, std::vector<Value>& latest) {
  if (latest.size() == most) latest.erase(latest.begin());
  latest.push_back(value);
}

double scatter_of(std::vector<double> values, double median) {
  for (double& value : values) value = std::abs(value - median);
  return kMadToDeviation * statistics::median(values);
}

}  // namespace

SteadySweeps::SteadySweeps(const LidarProfile& profile) : profile_(profile) {}

void SteadySweeps::learn(geometry::Stamp stamp, double first_s, double last_s) {
  if (!stamps_.empty()) {
    const double interval_s = geometry::seconds_between(stamps_.back(), stamp);
    if (interval_s > 0) remember(interval_s, kRemembered, intervals_s_);
  }
  remember(stamp, kRemembered, stamps_);
  if (last_s > first_s) {
    remember(last_s - first_s, kRemembered, spans_s_);
    remember(0.5 * (first_s + last_s), kRemembered, middles_s_);
  }
}

double SteadySweeps::interval(geometry::Stamp earlier, geometry::Stamp later) const {
  const double stamped = scan_interval(earlier, later, profile_);
  if (profile_.time_source != TimeSource::kData || intervals_s_.size() < kEnough) return stamped;
  const double usual_s = statistics::median(intervals_s_);
  const double span_s = spans_s_.empty() ? 0 : statistics::median(spans_s_);
  if (std::abs(span_s - usual_s) > kContinuous * usual_s) return stamped;
  const double scatter_s = scatter_of(intervals_s_, usual_s);
  if (scatter_s <= kScatter * usual_s) return stamped;
  const auto from = std::find(stamps_.begin(), stamps_.end(), earlier);
  const auto to = std::find(stamps_.begin(), stamps_.end(), later);
  if (from == stamps_.end() || to == stamps_.end() || to <= from) return stamped;
  const double jitter_s = scatter_s / std::numbers::sqrt2;  // an interval has that of two stamps
  const std::vector<double> sweeps = counted_sweeps(span_s, jitter_s);
  const double counted = sweeps[static_cast<std::size_t>(to - stamps_.begin())] -
                         sweeps[static_cast<std::size_t>(from - stamps_.begin())];
  // The points span a sweep but for the gap between the last and the first of the next; the stamps
  // tell it in full, as soon as there are enough of them.
  const double all = sweeps.back();
  const bool is_long = scatter_s < kScatter * all * span_s;
  const double period_s =
      is_long ? geometry::seconds_between(stamps_.front(), stamps_.back()) / all : span_s;
  return counted * period_s;
}

std::vector<double> SteadySweeps::counted_sweeps(double period_s, double jitter_s) const {
  constexpr double kFollow = 0.1;               // of a stamp's distance from the clock
  const double late = 2 * jitter_s / period_s;  // sweeps: what is no loss yet
  std::vector<double> counts;
  double clock_s = 0;  // after the oldest stamp
  double count = 0;
  for (const geometry::Stamp& stamp : stamps_) {
    const double stamp_s = geometry::seconds_between(stamps_.front(), stamp);
    if (!counts.empty()) {
      const double sweeps = std::max(1.0, std::round((stamp_s - clock_s) / period_s - late));
      count += sweeps;
      clock_s += sweeps * period_s;
      clock_s += kFollow * (stamp_s - clock_s);
    }
    counts.push_back(count);
  }
  return counts;
}

bool SteadySweeps::lacks_times(double first_s, double last_s) const {
  return !spans_s_.empty() && last_s - first_s < 0.5 * statistics::median(spans_s_);
}

double SteadySweeps::usual_middle_s() const {
  return middles_s_.empty() ? 0 : statistics::median(middles_s_);
}

}  // namespace traverse::sensors
