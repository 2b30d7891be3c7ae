#include "traverse/optimization/solution.hpp"

#include <utility>

namespace traverse::optimization {

namespace {

Termination reason_of(const ceres::Solver::Summary& summary) {
  if (!summary.IsSolutionUsable()) return Termination::kNotSolvable;
  return summary.termination_type == ceres::CONVERGENCE ? Termination::kConverged
                                                        : Termination::kIterationLimit;
}

}  // namespace

Solution solve(const ceres::Solver::Options& options, ceres::Problem& problem) {
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  Solution solution;
  solution.is_usable = summary.IsSolutionUsable();
  solution.reason = reason_of(summary);
  solution.converged = solution.reason == Termination::kConverged;
  solution.message = std::move(summary.message);
  if (!summary.iterations.empty()) {  // the first one is the evaluation at the start
    solution.iterations = static_cast<int>(summary.iterations.size()) - 1;
    solution.trust_region_radius = summary.iterations.back().trust_region_radius;
  }
  return solution;
}

}  // namespace traverse::optimization
