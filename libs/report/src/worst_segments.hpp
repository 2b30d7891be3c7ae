#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "model.hpp"
#include "run_data.hpp"

namespace traverse::report {

/// A stretch of the drive on which the estimate did worst.
struct WorstSegment {
  std::size_t first = 0;  ///< poses of the estimate where it begins and ends
  std::size_t last = 0;
  double value = 0;  ///< in the unit of WorstSegments
};

struct WorstSegments {
  std::string measure;  ///< "RPE over 10 frames", or "residual rms" without a reference
  std::string unit;
  std::vector<WorstSegment> segments;  ///< the worst first, none overlaps another
};

/// The five worst: by the relative error over ten frames, or, without a reference, by the residuals
/// of the registration over as many.
WorstSegments worst_segments(const RunData& run);

void add_worst_segments(const RunData& run, const WorstSegments& worst, Model& model);

}  // namespace traverse::report
