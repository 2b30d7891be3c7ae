#include "traverse/evaluation/bootstrap.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>
#include <vector>

#include "traverse/evaluation/statistics.hpp"
#include "traverse/statistics/quantile.hpp"

namespace traverse::evaluation {

namespace {

constexpr std::size_t kFewestBlocks = 4;

/// A whole number from 0 to `count` - 1, the same with every standard library.
std::size_t uniform_below(std::mt19937_64& generator, std::size_t count) {
  constexpr double kTwoTo53 = 9007199254740992.0;
  const double share = static_cast<double>(generator() >> 11U) / kTwoTo53;
  return static_cast<std::size_t>(share * static_cast<double>(count));
}

std::vector<double> autocovariances(std::span<const double> values, std::size_t max_lag) {
  const auto n = static_cast<double>(values.size());
  double mean = 0;
  for (const double value : values) mean += value / n;
  std::vector<double> result(max_lag + 1, 0.0);
  for (std::size_t lag = 0; lag <= max_lag; ++lag) {
    for (std::size_t i = lag; i < values.size(); ++i) {
      result[lag] += (values[i] - mean) * (values[i - lag] - mean) / n;
    }
  }
  return result;
}

/// The lag from which on the values no longer depend on each other: the first after which `run`
/// autocorrelations in a row are insignificant.
std::size_t last_significant_lag(const std::vector<double>& covariance, std::size_t run,
                                 std::size_t values) {
  const auto n = static_cast<double>(values);
  const double bound = 2 * std::sqrt(std::log10(n) / n) * covariance.front();
  std::size_t insignificant = 0;
  for (std::size_t lag = 1; lag < covariance.size(); ++lag) {
    insignificant = std::abs(covariance[lag]) < bound ? insignificant + 1 : 0;
    if (insignificant == run) return lag - run;
  }
  return covariance.size() - 1;
}

/// Flat-top window: 1 up to a half, then falling to 0 at 1.
double window(double share) { return std::clamp(2 * (1 - share), 0.0, 1.0); }

void require_valid(const BootstrapOptions& options) {
  if (!(options.confidence > 0 && options.confidence < 1) || options.resamples < 2) {
    throw std::invalid_argument(
        "a bootstrap needs a confidence between 0 and 1 and two resamples or more");
  }
}

/// Calls `use` with the numbers of the values of each resample.
void for_each_resample(std::size_t count, std::size_t block, const BootstrapOptions& options,
                       const std::function<void(std::span<const std::size_t>)>& use) {
  std::mt19937_64 generator(options.seed);
  std::vector<std::size_t> numbers(count);
  for (std::size_t k = 0; k < options.resamples; ++k) {
    for (std::size_t filled = 0; filled < count;) {
      const std::size_t start = uniform_below(generator, count - block + 1);
      for (std::size_t i = 0; i < block && filled < count; ++i) numbers[filled++] = start + i;
    }
    use(numbers);
  }
}

Interval interval_of(std::span<const double> figures, std::size_t block,
                     const BootstrapOptions& options) {
  const double tail = (1 - options.confidence) / 2;
  return {statistics::quantile(figures, tail), statistics::quantile(figures, 1 - tail),
          options.confidence, block, options.resamples};
}

void take(std::span<const double> values, std::span<const std::size_t> numbers,
          std::vector<double>& taken) {
  taken.resize(numbers.size());
  std::transform(numbers.begin(), numbers.end(), taken.begin(),
                 [&](std::size_t number) { return values[number]; });
}

}  // namespace

double figure_of(std::span<const double> values, Figure figure) {
  if (values.empty()) throw std::invalid_argument("a figure needs at least one value");
  if (figure == Figure::kMedian) return statistics::quantile(values, 0.5);
  if (figure == Figure::kP95) return statistics::quantile(values, 0.95);
  double sum = 0;
  for (const double value : values) sum += figure == Figure::kRmse ? value * value : value;
  const double mean = sum / static_cast<double>(values.size());
  return figure == Figure::kRmse ? std::sqrt(mean) : mean;
}

std::size_t block_length(std::span<const double> values) {
  const std::size_t longest = std::max<std::size_t>(1, values.size() / kFewestBlocks);
  if (values.size() < kFewestForInterval) return 1;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (*least == *most) return 1;  // told apart here: their covariance is only nearly zero
  const auto n = static_cast<double>(values.size());
  const auto run =
      std::max<std::size_t>(5, static_cast<std::size_t>(std::ceil(std::sqrt(std::log10(n)))));
  const auto max_lag =
      std::min(values.size() - 1, static_cast<std::size_t>(std::ceil(std::sqrt(n))) + run);
  const std::vector<double> covariance = autocovariances(values, max_lag);
  const std::size_t span = std::min(
      max_lag, 2 * std::max<std::size_t>(1, last_significant_lag(covariance, run, values.size())));
  double spectrum = covariance.front();
  double slope = 0;
  for (std::size_t lag = 1; lag <= span; ++lag) {
    const double weighted =
        2 * window(static_cast<double>(lag) / static_cast<double>(span)) * covariance[lag];
    spectrum += weighted;
    slope += weighted * static_cast<double>(lag);
  }
  const double D = 4.0 / 3 * spectrum * spectrum;
  if (!(D > 0)) return longest;
  const double length = std::cbrt(2 * slope * slope / D * n);
  return std::clamp(static_cast<std::size_t>(std::ceil(std::min(length, n))), std::size_t{1},
                    longest);
}

std::optional<Interval> bootstrap_interval(std::span<const double> values, Figure figure,
                                           const BootstrapOptions& options) {
  require_valid(options);
  if (values.size() < kFewestForInterval) return std::nullopt;
  const std::size_t block = block_length(values);
  std::vector<double> figures;
  std::vector<double> taken;
  for_each_resample(values.size(), block, options, [&](std::span<const std::size_t> numbers) {
    take(values, numbers, taken);
    figures.push_back(figure_of(taken, figure));
  });
  return interval_of(figures, block, options);
}

std::optional<PairedDifference> bootstrap_difference(std::span<const double> baseline,
                                                     std::span<const double> candidate,
                                                     Figure figure,
                                                     const BootstrapOptions& options) {
  require_valid(options);
  if (baseline.size() != candidate.size()) {
    throw std::invalid_argument("paired series must agree in size");
  }
  if (baseline.size() < kFewestForInterval) return std::nullopt;
  std::vector<double> differences;
  for (std::size_t i = 0; i < baseline.size(); ++i) {
    differences.push_back(candidate[i] - baseline[i]);
  }
  const std::size_t block = block_length(differences);
  std::vector<double> figures;
  std::vector<double> of_baseline;
  std::vector<double> of_candidate;
  for_each_resample(baseline.size(), block, options, [&](std::span<const std::size_t> numbers) {
    take(baseline, numbers, of_baseline);
    take(candidate, numbers, of_candidate);
    figures.push_back(figure_of(of_candidate, figure) - figure_of(of_baseline, figure));
  });
  return PairedDifference{figure_of(candidate, figure) - figure_of(baseline, figure),
                          interval_of(figures, block, options)};
}

}  // namespace traverse::evaluation
