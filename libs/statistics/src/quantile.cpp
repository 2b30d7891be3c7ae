#include "traverse/statistics/quantile.hpp"

#include <stdexcept>

namespace traverse::statistics {

namespace {

template <typename Number>
double linear_quantile(std::span<const Number> values, double fraction) {
  if (values.empty() || !(fraction >= 0 && fraction <= 1)) {
    throw std::invalid_argument("a quantile needs a value and a fraction from 0 to 1");
  }
  std::vector<Number> sorted(values.begin(), values.end());
  const double place = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(sorted.begin(), at, sorted.end());
  const auto low = static_cast<double>(*at);
  if (below + 1 == sorted.size()) return low;
  const auto high = static_cast<double>(*std::min_element(at + 1, sorted.end()));
  return low + (place - static_cast<double>(below)) * (high - low);
}

}  // namespace

double quantile(std::span<const double> values, double fraction) {
  return linear_quantile(values, fraction);
}

double quantile(std::span<const float> values, double fraction) {
  return linear_quantile(values, fraction);
}

double median(std::span<const double> values) { return quantile(values, 0.5); }

}  // namespace traverse::statistics
