#pragma once

#include <optional>
#include <vector>

#include "traverse/geometry/stamp.hpp"

namespace traverse::dataset {

/// What became of stamps that were put back on a clock.
struct ClockFit {
  double period_s = 0;     ///< of the clock, in the time of the stamps
  double max_moved_s = 0;  ///< that a stamp was off its place
  double rms_moved_s = 0;
  std::size_t missing = 0;  ///< ticks without a reading
};

/// Stamps of readings that a sensor takes at regular moments but that are stamped when they arrive,
/// some milliseconds later or earlier than usual, moved to the straight line (of least squares)
/// through them over the number of their tick. The mean delay stays in them. A reading may be
/// missing, a stamp be off by up to half a period.
/// \param stamps  rising
/// \returns nothing, the stamps as they were, if they are fewer than 10 or do not keep the period
std::optional<ClockFit> put_on_clock(std::vector<geometry::Stamp>& stamps, double period_s);

}  // namespace traverse::dataset
