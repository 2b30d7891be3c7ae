#include "comparison/ratio.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::plausibility {

void Ratio::add(double x, double y) {
  if (x != 0) pairs_.push_back({y / x, std::abs(x)});
}

std::optional<Ratio::Result> Ratio::find(std::size_t min_pairs, double min_sum) const {
  Result result;
  result.pairs = pairs_.size();
  double negative = 0;
  for (const Pair& pair : pairs_) {
    result.sum += pair.weight;
    if (pair.ratio < 0) negative += pair.weight;
  }
  if (result.pairs < min_pairs || result.sum < min_sum) return std::nullopt;
  const auto weighted_median = [&](std::vector<Pair> pairs) {
    std::sort(pairs.begin(), pairs.end(),
              [](const Pair& a, const Pair& b) { return a.ratio < b.ratio; });
    double sum = 0;
    for (const Pair& pair : pairs) {
      sum += pair.weight;
      if (sum >= result.sum / 2) return pair.ratio;
    }
    return pairs.back().ratio;
  };
  result.negative_share = result.sum > 0 ? negative / result.sum : 0;
  result.value = weighted_median(pairs_);
  std::vector<Pair> deviations = pairs_;
  for (Pair& pair : deviations) pair.ratio = std::abs(pair.ratio - result.value);
  const double deviation = weighted_median(std::move(deviations));
  result.spread = result.value != 0 ? deviation / std::abs(result.value) : 1;
  return result;
}

}  // namespace traverse::plausibility
