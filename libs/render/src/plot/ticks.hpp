#pragma once

#include <string>
#include <vector>

#include "traverse/render/plot/range.hpp"

namespace traverse::render {

/// Round numbers along an axis.
struct Ticks {
  double step = 1;             ///< 1, 2 or 5 times a power of ten
  std::vector<double> values;  ///< multiples of the step inside the range, ascending
};

/// The smallest of 1, 2 and 5 times a power of ten that is not below `least`.
double nice_step_at_least(double least);
/// The largest that is not above `most`.
double nice_step_at_most(double most);

/// At most `at_most` ticks in `range`; none if the range is empty or not finite.
Ticks nice_ticks(Range range, int at_most);
/// All multiples of `step` in `range`; none if there would be more than a thousand.
Ticks ticks_of_step(Range range, double step);

/// How the numbers of an axis are shortened: what its labels show is (value - offset) /
/// 10^exponent.
struct Notation {
  double offset = 0;
  int exponent = 0;

  /// Subtracts an offset where the span is small beside the values (map coordinates), else takes
  /// out a power of a thousand where they are very large or very small.
  static Notation for_range(Range range);

  /// "x [m]", "x − 455 000 [m]", "rotation [10⁻³ deg/m]".
  std::string axis_label(const std::string& name, const std::string& unit) const;
};

/// The labels of `ticks`, all with the decimals that their step needs: "−0.5", "12 000".
std::vector<std::string> tick_labels(const Ticks& ticks, const Notation& notation = {});

}  // namespace traverse::render
