#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "traverse/evaluation/evaluate.hpp"

namespace traverse::evaluation {

/// A stretch of the drive on which the estimate did worst.
struct WorstSegment {
  std::size_t first = 0;  ///< poses of the estimate where it begins and ends
  std::size_t last = 0;
  double value = 0;  ///< in the unit of WorstSegments
};

struct WorstSegments {
  std::string measure;  ///< "RPE over 10 frames", or "residual rms over 10 frames"
  std::string unit;
  std::vector<WorstSegment> segments;  ///< the worst first, none overlaps another
};

/// The five worst: by the relative error over ten frames, the median of five pairs that begin one
/// frame after the other, so that no single pose that jitters makes a segment; or, where there is
/// none, by the residuals of the registration over as many. \param residual_rms_m one a pose of the
/// estimate; may be empty
WorstSegments worst_segments(const Evaluation& evaluation, std::span<const double> residual_rms_m);

}  // namespace traverse::evaluation
