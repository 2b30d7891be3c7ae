#pragma once

#include <cstddef>
#include <span>

namespace traverse::evaluation {

/// Of a set of errors, in their unit; nothing is taken out as an outlier.
struct Statistics {
  double rmse = 0;  ///< sqrt(mean of squares)
  double mean = 0;
  double median = 0;  ///< of an even count the mean of the two in the middle
  double std = 0;     ///< of the population: divided by count
  double min = 0;
  double max = 0;
  double sse = 0;  ///< sum of squares, in the unit squared
  std::size_t count = 0;
};

/// \throws std::invalid_argument if there are no values.
Statistics statistics_of(std::span<const double> values);

}  // namespace traverse::evaluation
