#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace traverse::evaluation {

/// What is computed of a series of values.
enum class Figure { kMean, kRmse, kMedian, kP95 };

/// \throws std::invalid_argument if there are no values.
double figure_of(std::span<const double> values, Figure figure);

struct BootstrapOptions {
  double confidence = 0.95;
  std::size_t resamples = 2000;
  std::uint64_t seed = 1;  ///< the same seed gives the same interval
};

/// Where a figure would lie if the drive were repeated under like conditions.
struct Interval {
  double low = 0;
  double high = 0;
  double confidence = 0.95;
  std::size_t block_length = 1;  ///< values a block
  std::size_t resamples = 0;
};

/// Fewer values than this say too little about how they depend on each other.
inline constexpr std::size_t kFewestForInterval = 20;

/// Values that follow one another on a drive are alike, so the bootstrap draws them in blocks. The
/// block is as long as keeps the variance of the mean, found from the autocovariances. Source:
/// Politis and White, "Automatic block-length selection for the dependent bootstrap", Econometric
/// Reviews 23, 2004, with the correction of Patton, Politis and White, 2009; a quarter of the
/// values at most, so that there are four blocks to draw from.
std::size_t block_length(std::span<const double> values);

/// Percentile interval of the moving-block bootstrap, of values in the order of time; nothing for
/// fewer than kFewestForInterval. Source: Kuensch, "The jackknife and the bootstrap for general
/// stationary observations", Annals of Statistics 17, 1989.
///
/// It covers what varies within one drive, not between drives: a bias that is the same all along
/// does not widen it. \throws std::invalid_argument for options out of range.
std::optional<Interval> bootstrap_interval(std::span<const double> values, Figure figure,
                                           const BootstrapOptions& options = {});

/// How a candidate differs from a baseline on the same moments.
struct PairedDifference {
  double difference = 0;  ///< figure of the candidate minus that of the baseline
  Interval interval;      ///< of the difference
};

/// The same blocks of both series are drawn together, so that what makes a stretch of road hard
/// for both does not count. Nothing for fewer than kFewestForInterval values.
/// \throws std::invalid_argument if the sizes differ.
std::optional<PairedDifference> bootstrap_difference(std::span<const double> baseline,
                                                     std::span<const double> candidate,
                                                     Figure figure,
                                                     const BootstrapOptions& options = {});

}  // namespace traverse::evaluation
