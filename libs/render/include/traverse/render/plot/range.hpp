#pragma once

#include <span>

namespace traverse::render {

/// What an axis or a colour scale covers, low to high.
struct Range {
  double low = 0;
  double high = 1;

  double span() const { return high - low; }
  bool contains(double value) const { return value >= low && value <= high; }

  /// Of all finite `values`; [0, 1] if there is none.
  static Range of(std::span<const double> values);
  /// The smallest that covers both.
  Range joined(const Range& other) const;
  /// Wider by `share` of its span at each end.
  Range padded(double share) const;
  /// At least `min_span` wide about the same middle.
  Range at_least(double min_span) const;
};

/// The value below which `percent` of the finite `values` lie, interpolated between neighbours; NaN
/// if there is none. The values are taken by value because they are sorted in part.
double percentile(std::span<const double> values, double percent);
double percentile(std::span<const float> values, double percent);

}  // namespace traverse::render
