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
  std::size_t judged_levels = 0;
};

/// What is solved for.
struct GraphState {
  std::vector<geometry::Pose3>& poses;  ///< in the order of index_of
  Eigen::Vector3d& up_map;              ///< a unit vector; stays where ENU tells it
  Eigen::Vector3d& up_offset;
};

/// Of one axis of up_offset [rad].
double up_offset_sigma(const GraphOptions& options);

/// The chi-square that a consistent measurement of so many rows exceeds with that probability.
double chi2_bound(int rows, double probability);

/// Moves the state to the least robust sum of squares. What was rejected before does not widen the
/// first stage's bound, only what is new does; but it takes part wherever it comes within it.
Result solve(const GraphParts& graph, const GraphOptions& options, const GraphState& state);

}  // namespace traverse::pose_graph
