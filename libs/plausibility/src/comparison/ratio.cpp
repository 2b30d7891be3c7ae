#include "comparison/ratio.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "traverse/statistics/quantile.hpp"

namespace traverse::plausibility {

void Ratio::add(double x, double y) {
  if (x != 0) pairs_.push_back({y / x, std::abs(x)});
}

std::optional<Ratio::Result> Ratio::find(std::size_t min_pairs, double min_sum) const {
  if (pairs_.empty()) return std::nullopt;
  // What is far larger than the rest is an outlier, and must not outweigh it.
  constexpr double kMaxWeight = 3;  // medians
  std::vector<double> weights;
  for (const Pair& pair : pairs_) weights.push_back(pair.weight);
  const double largest = kMaxWeight * statistics::element_at_share(weights, 0.5);
  std::vector<Pair> pairs = pairs_;
  Result result;
  result.pairs = pairs.size();
  double negative = 0;
  for (Pair& pair : pairs) {
    pair.weight = std::min(pair.weight, largest);
    result.sum += pair.weight;
    if (pair.ratio < 0) negative += pair.weight;
  }
  if (result.pairs < min_pairs || !(result.sum > 0) || result.sum < min_sum) return std::nullopt;
  result.negative_share = negative / result.sum;
  result.value = weighted_median(pairs, result.sum);
  for (Pair& pair : pairs) pair.ratio = std::abs(pair.ratio - result.value);
  const double deviation = weighted_median(std::move(pairs), result.sum);
  result.spread = result.value != 0 ? deviation / std::abs(result.value) : 1;
  return result;
}

/// The ratio below and above which half of the weight is.
double Ratio::weighted_median(std::vector<Pair> pairs, double weight) {
  std::sort(pairs.begin(), pairs.end(),
            [](const Pair& a, const Pair& b) { return a.ratio < b.ratio; });
  double sum = 0;
  for (const Pair& pair : pairs) {
    sum += pair.weight;
    if (sum >= weight / 2) return pair.ratio;
  }
  return pairs.back().ratio;
}

}  // namespace traverse::plausibility
