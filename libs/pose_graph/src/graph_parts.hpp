#pragma once

#include <map>
#include <vector>

#include "traverse/pose_graph/pose_graph.hpp"

namespace traverse::pose_graph {

/// What a graph is made of, seen by the solver. Chi-squares are those at the present poses.
struct GraphParts {
  const std::vector<Edge>& edges;
  const std::vector<Fix>& fixes;
  const std::vector<Level>& levels;
  const std::map<NodeId, std::size_t>& index_of;
  bool is_georeferenced = false;
};

/// The odometry that leads to each node from the one before it in the order of index_of; null where
/// a chain begins.
std::vector<const Edge*> steps_of(const GraphParts& graph);

/// Loops and fixes that a solution has contradicted, one an edge and one a fix.
struct Doubts {
  std::vector<bool> edges;
  std::vector<bool> fixes;
};

}  // namespace traverse::pose_graph
