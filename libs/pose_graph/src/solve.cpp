#include "solve.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <numbers>
#include <utility>

#include "graph_problem.hpp"
#include "loop_consistency.hpp"

namespace traverse::pose_graph {

namespace {

// Chi-squares beyond the bound by this factor are looked at before they are believed.
constexpr double kFar = 100;

void count(const optimization::Solution& solution, Result& result) {
  ++result.stages;
  result.iterations += solution.iterations;
}

/// Graduated non-convexity: the bound shrinks, each stage goes on from the solution before. As long
/// as it is beyond every chi-square nothing would change, so those stages are passed over.
void graduate(GraphProblem& problem, const GraphOptions& options, Result& result) {
  double widening = problem.widest();
  while (widening > 1) {
    const optimization::Solution solution = problem.stage(widening, options.steps_a_stage);
    count(solution, result);
    if (!solution.is_usable) return;
    widening = std::min(widening / options.graduation, problem.widest());
  }
}

/// Loops beyond the bound by far. Cheaper to look at than to solve with.
bool is_far_off(const GraphParts& graph, const Doubts& doubts, double bound) {
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    const Edge& edge = graph.edges[e];
    const bool is_new = edge.kind == EdgeKind::kLoop && !doubts.edges[e];
    if (is_new && edge.chi2 > kFar * bound) return true;
  }
  return false;
}

}  // namespace

double chi2_bound(int rows, double probability) {
  return boost::math::quantile(
      boost::math::complement(boost::math::chi_squared(rows), probability));
}

double up_offset_sigma(const GraphOptions& options) {
  return options.up_offset_deg * std::numbers::pi / 180;
}

Result solve(const GraphParts& graph, Doubts doubts, const GraphOptions& options,
             const GraphState& state) {
  Result result;
  const double bound = chi2_bound(6, options.outlier_probability);
  if (options.robust && is_far_off(graph, doubts, bound)) {
    doubts.edges = contradicted_loops(graph, bound);
  }
  result.doubted_loops =
      static_cast<std::size_t>(std::count(doubts.edges.begin(), doubts.edges.end(), true));
  GraphProblem problem(graph, doubts, options, state);
  if (options.robust) graduate(problem, options, result);
  optimization::Solution solution;
  do {
    solution = problem.finish(options.max_iterations);
    count(solution, result);
  } while (solution.is_usable && problem.take_in_or_leave_out() &&
           result.iterations < 4 * options.max_iterations);
  result.is_usable = solution.is_usable;
  result.converged = solution.converged;
  result.reason = solution.reason;
  result.message = std::move(solution.message);
  if (result.is_usable) problem.take_solution(state);
  return result;
}

}  // namespace traverse::pose_graph
