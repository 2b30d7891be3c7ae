#pragma once

#include <vector>

#include "graph_parts.hpp"

namespace traverse::pose_graph {

/// Of one axis of what all measured ups are off by [rad].
double up_offset_sigma(const GraphOptions& options);

/// The chi-square that a consistent measurement of so many rows exceeds with that probability.
double chi2_bound(int rows, double probability);

/// Moves the state to the least robust sum of squares.
/// \param doubts what was rejected before: it does not widen the first stage's bound, only what is
/// new does; but it takes part wherever it comes within it
/// \returns also whether it could be solved; if not, the state is left as it was
Result solve(const GraphParts& graph, Doubts doubts, const GraphOptions& options,
             const GraphState& state);

}  // namespace traverse::pose_graph
