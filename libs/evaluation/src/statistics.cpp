#include "traverse/evaluation/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "traverse/statistics/quantile.hpp"

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
  s.median = statistics::median(values);
  return s;
}

}  // namespace traverse::evaluation
