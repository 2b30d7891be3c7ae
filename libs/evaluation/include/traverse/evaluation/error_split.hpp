#pragma once

#include <cstddef>
#include <optional>

#include "traverse/evaluation/poses.hpp"

namespace traverse::evaluation {

/// Of the signed errors in one direction, metres.
struct ErrorPart {
  double rmse_m = 0;
  double mean_m = 0;  ///< signed: what the estimate is off by all along
  double max_m = 0;   ///< the largest magnitude
};

/// The absolute position errors along, across (to the left of) and up from the path of the
/// reference, estimate less reference. What timing or scale does is along; what heading does,
/// across.
struct ErrorSplit {
  ErrorPart along;
  ErrorPart across;
  ErrorPart up;
  std::size_t poses = 0;  ///< that have a direction: near them the reference moves
  /// About the standard deviation of what changes along the path from one frame to the next and
  /// back: jitter, of which an estimator that smooths over time makes little. Nothing for fewer
  /// than 20 errors.
  std::optional<double> alternating_m;

  /// Whether jitter makes at least half of the error along the path (root mean square), and that
  /// at least half of the whole: then stamps or the reference explain the error, not the estimate.
  bool alternates() const;
};

/// Of matched poses, the estimate already aligned. A pose's direction is from the last reference
/// pose at least 1 m before it to the first at least 1 m after it. Up is the mean of the body's z
/// axis over the reference or, where the body moves along its own z axis as a camera does, of its
/// -y axis. Nothing where the reference never moves so far. \throws std::invalid_argument if the
/// sizes differ or are zero.
std::optional<ErrorSplit> error_split(const Poses& estimate, const Poses& reference);

}  // namespace traverse::evaluation
