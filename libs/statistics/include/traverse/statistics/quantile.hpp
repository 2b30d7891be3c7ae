#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace traverse::statistics {

/// The value that a share `fraction` of `values` does not exceed, linear between neighbours in the
/// ascending order: place (n - 1) * fraction, counted from 0 (type 7 of Hyndman and Fan, "Sample
/// quantiles in statistical packages", 1996; what evo, numpy and R give). The rule of every figure
/// that people read. `values` are finite, in any order.
/// \throws std::invalid_argument without values or for a fraction outside [0, 1].
double quantile(std::span<const double> values, double fraction);
double quantile(std::span<const float> values, double fraction);

/// quantile() at one half: of an even count the mean of the two in the middle.
double median(std::span<const double> values);

/// For algorithms that need one of the values itself: that of rank floor(share * n), counted from 0
/// in the ascending order, so the upper one of the two in the middle for a share of one half.
/// Reorders `values`, of which there is at least one.
template <typename Number>
Number element_at_share(std::vector<Number>& values, double share) {
  const auto rank = std::min(values.size() - 1,
                             static_cast<std::size_t>(share * static_cast<double>(values.size())));
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace traverse::statistics
