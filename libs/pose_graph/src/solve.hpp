#pragma once

#include <map>
#include <vector>

#include "traverse/pose_graph/pose_graph.hpp"

namespace traverse::pose_graph {

/// What a graph is made of, seen by the solver.
struct GraphParts {
  const std::vector<Edge>& edges;
  const std::vector<Fix>& fixes;
  const std::vector<Level>& levels;
  const std::map<NodeId, std::size_t>& index_of;
  bool is_georeferenced = false;
  std::size_t judged_edges = 0;  ///< the first ones, which the last solution has judged
  std::size_t judged_fixes = 0;
};

/// The chi-square that a consistent measurement of so many rows exceeds with that probability.
double chi2_bound(int rows, double probability);

/// Moves the poses, and up where nothing tells it, to the least robust sum of squares. Loops and
/// fixes that were rejected before do not widen the first stage's bound, only new ones do; but they
/// take part wherever they come within it.
/// \param poses in the order of index_of  \param up_map a unit vector
Result solve(const GraphParts& graph, const GraphOptions& options,
             std::vector<geometry::Pose3>& poses, Eigen::Vector3d& up_map);

}  // namespace traverse::pose_graph
