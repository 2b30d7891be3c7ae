#include "kitti/regular_clock.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traverse::dataset {

namespace {

using geometry::seconds_between;
using geometry::Stamp;

/// Where in its period the clock ticks, after the first stamp: the circular mean of the first ones.
double phase_of(const std::vector<Stamp>& stamps, double period_s) {
  constexpr std::size_t kFirst = 50;
  double cosine = 0;
  double sine = 0;
  for (std::size_t k = 0; k < std::min(kFirst, stamps.size()); ++k) {
    const double angle =
        2 * std::numbers::pi * seconds_between(stamps.front(), stamps[k]) / period_s;
    cosine += std::cos(angle);
    sine += std::sin(angle);
  }
  return std::atan2(sine, cosine) / (2 * std::numbers::pi) * period_s;
}

/// The number of each stamp's tick, counted from the first; the clock's offset follows slowly, so
/// that its own rate need not be exactly what is stated. Nothing if two stamps share a tick.
std::optional<std::vector<double>> ticks_of(const std::vector<Stamp>& stamps, double period_s) {
  constexpr double kFollow = 0.05;
  constexpr double kMostTicks = 9e15;  // what a double counts one by one
  std::vector<double> ticks;
  double offset = phase_of(stamps, period_s);
  for (const Stamp stamp : stamps) {
    const double seconds = seconds_between(stamps.front(), stamp) - offset;
    const double tick = std::round(seconds / period_s);
    if (!(std::abs(tick) < kMostTicks)) return std::nullopt;
    if (!ticks.empty() && tick <= ticks.back()) return std::nullopt;
    offset += kFollow * (seconds - tick * period_s);
    ticks.push_back(tick);
  }
  return ticks;
}

}  // namespace

std::optional<ClockFit> put_on_clock(std::vector<Stamp>& stamps, double period_s) {
  constexpr std::size_t kLeast = 10;
  if (stamps.size() < kLeast) return std::nullopt;
  const auto ticks = ticks_of(stamps, period_s);
  if (!ticks) return std::nullopt;
  const auto count = static_cast<double>(stamps.size());
  double mean_tick = 0;
  double mean_seconds = 0;
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    mean_tick += (*ticks)[k] / count;
    mean_seconds += seconds_between(stamps.front(), stamps[k]) / count;
  }
  double squares = 0;
  double products = 0;
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    const double tick = (*ticks)[k] - mean_tick;
    squares += tick * tick;
    products += tick * (seconds_between(stamps.front(), stamps[k]) - mean_seconds);
  }
  ClockFit fit;
  fit.period_s = products / squares;
  fit.missing = static_cast<std::size_t>(ticks->back() - ticks->front()) + 1 - stamps.size();
  const Stamp first = stamps.front();
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    const double place = mean_seconds + fit.period_s * ((*ticks)[k] - mean_tick);
    const double moved = place - seconds_between(first, stamps[k]);
    fit.max_moved_s = std::max(fit.max_moved_s, std::abs(moved));
    fit.rms_moved_s += moved * moved / count;
    stamps[k] = geometry::shifted(first, place);
  }
  fit.rms_moved_s = std::sqrt(fit.rms_moved_s);
  return fit;
}

}  // namespace traverse::dataset
