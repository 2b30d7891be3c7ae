#include "traverse/render/plot/range.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "traverse/statistics/quantile.hpp"

namespace traverse::render {

namespace {

template <typename Number>
double percentile_of(std::span<const Number> values, double percent) {
  std::vector<Number> finite;
  finite.reserve(values.size());
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
               [](Number value) { return std::isfinite(value); });
  if (finite.empty()) return std::numeric_limits<double>::quiet_NaN();
  return statistics::quantile(finite, std::clamp(percent, 0.0, 100.0) / 100);
}

}  // namespace

Range Range::of(std::span<const double> values) {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    range = {std::min(range.low, value), std::max(range.high, value)};
  }
  return range.low <= range.high ? range : Range{};
}

Range Range::joined(const Range& other) const {
  return {std::min(low, other.low), std::max(high, other.high)};
}

Range Range::padded(double share) const { return {low - share * span(), high + share * span()}; }

Range Range::at_least(double min_span) const {
  const double missing = std::max(0.0, min_span - span());
  return {low - missing / 2, high + missing / 2};
}

double percentile(std::span<const double> values, double percent) {
  return percentile_of(values, percent);
}

double percentile(std::span<const float> values, double percent) {
  return percentile_of(values, percent);
}

}  // namespace traverse::render
