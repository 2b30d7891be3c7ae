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

/// What is solved for.
struct GraphState {
  std::vector<geometry::Pose3>& poses;  ///< in the order of index_of
  Eigen::Vector3d& up_map;              ///< a unit vector; stays where ENU tells it
  Eigen::Vector3d& up_offset;
};

/// Loops, fixes and directions of up that a solution has contradicted: one an edge, fix and level.
struct Doubts {
  std::vector<bool> edges;
  std::vector<bool> fixes;
  std::vector<bool> levels;
};

}  // namespace traverse::pose_graph
