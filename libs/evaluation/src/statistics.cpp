#include "traverse/evaluation/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace traverse::evaluation {

Statistics statistics_of(std::span<const double> values) {
  if (values.empty()) throw std::invalid_argument("statistics need at least one value");
  Statistics s;
  s.count = values.size();
  const auto n = static_cast<double>(values.size());
  for (const double value : values) {
    s.mean += value / n;
    s.sse += value * value;
  }
  s.rmse = std::sqrt(s.sse / n);
  double squared_deviations = 0;
  for (const double value : values) squared_deviations += (value - s.mean) * (value - s.mean);
  s.std = std::sqrt(squared_deviations / n);
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  s.min = *least;
  s.max = *most;
  s.median = quantile(values, 0.5);
  return s;
}

double quantile(std::span<const double> values, double fraction) {
  if (values.empty() || !(fraction >= 0 && fraction <= 1)) {
    throw std::invalid_argument("a quantile needs a value and a fraction from 0 to 1");
  }
  std::vector<double> sorted(values.begin(), values.end());
  const double place = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(sorted.begin(), middle, sorted.end());
  if (below + 1 == sorted.size()) return *middle;
  const double above = *std::min_element(middle + 1, sorted.end());
  return *middle + (place - static_cast<double>(below)) * (above - *middle);
}

}  // namespace traverse::evaluation
