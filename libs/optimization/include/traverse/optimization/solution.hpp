#pragma once

#include <optional>
#include <string>

#include <ceres/problem.h>
#include <ceres/solver.h>

#include "traverse/optimization/termination.hpp"

namespace traverse::optimization {

/// What a solution by Ceres came to.
///
/// A ceres::Solver::Summary has no iterations when nothing is free to move, when the first
/// evaluation fails or when a parameter is not finite; so none is read but here.
///
/// This header shows Ceres: only sources include it, no public header.
struct Solution {
  bool is_usable = false;  ///< if not, the parameters are as they were
  bool converged = false;
  Termination reason = Termination::kNotRun;
  int iterations = 0;  ///< steps that were tried
  /// Of the trust region in the end; nothing without an iteration.
  std::optional<double> trust_region_radius;
  std::string message;  ///< Ceres' last word: the reason in detail
};

/// Minimises the problem and reads its summary.
Solution solve(const ceres::Solver::Options& options, ceres::Problem& problem);

}  // namespace traverse::optimization
