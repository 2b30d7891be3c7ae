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
};

/// The chi-square that a consistent measurement of so many rows exceeds with that probability.
double chi2_bound(int rows, double probability);

/// Moves the poses, and up where nothing tells it, to the least robust sum of squares.
/// \param poses in the order of index_of  \param up_map a unit vector
Result solve(const GraphParts& graph, const GraphOptions& options,
             std::vector<geometry::Pose3>& poses, Eigen::Vector3d& up_map);

}  // namespace traverse::pose_graph
