#pragma once

#include <vector>

#include "graph_parts.hpp"

namespace traverse::pose_graph {

/// The chi-square that a consistent measurement of so many rows exceeds with that probability.
double chi2_bound(int rows, double probability);

/// Moves the poses, and up where nothing tells it, to the least robust sum of squares.
/// \param doubts loops and fixes that were rejected before: they do not widen the first stage's
/// bound, only new ones do; but they take part wherever they come within it
/// \param poses in the order of index_of  \param up_map a unit vector
Result solve(const GraphParts& graph, Doubts doubts, const GraphOptions& options,
             std::vector<geometry::Pose3>& poses, Eigen::Vector3d& up_map);

}  // namespace traverse::pose_graph
