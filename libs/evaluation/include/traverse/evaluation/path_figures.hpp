#pragma once

#include <optional>
#include <vector>

#include "traverse/evaluation/poses.hpp"

namespace traverse::evaluation {

/// Below this length of the reference's path an error is not told in percent of it: of a vehicle
/// that stands the noise of the reference would be the path.
inline constexpr double kLeastPathForPercent_m = 10;

/// Lengths of the two paths and how far they end from each other when they start together.
struct PathFigures {
  double estimate_m = 0;   ///< path length over the matched poses
  double reference_m = 0;  ///< the same of the reference
  double end_error_m = 0;  ///< closing error: of the last poses, the first brought to coincide
  std::optional<double> end_error_percent;  ///< of reference_m; nothing where that is short
  double end_rotation_deg = 0;              ///< angle between the last poses
};

/// Of matched poses that are not aligned. \throws std::invalid_argument if the sizes differ or are
/// zero.
PathFigures path_figures(const Poses& estimate, const Poses& reference);

/// Path length from the first pose to each, metres; the first is 0.
std::vector<double> accumulated_distances(const Poses& poses);
/// The last of them; 0 without poses.
double path_length(const Poses& poses);

}  // namespace traverse::evaluation
