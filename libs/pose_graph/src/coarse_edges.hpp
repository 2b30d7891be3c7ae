#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "graph_parts.hpp"
#include "measured_motion.hpp"

namespace traverse::pose_graph {

/// A measured motion between two nodes of few, by their numbers.
struct CoarseEdge {
  std::size_t i = 0;
  std::size_t j = 0;
  MeasuredMotion motion;
};

/// A graph's edges moved to a few of its nodes.
struct CoarseEdges {
  std::size_t nodes = 0;
  std::vector<std::optional<CoarseEdge>> edges;  ///< nothing for one within a single coarse node
};

/// Each node is carried along by the last coarse one before it, by the motion that odometry
/// measured between the two; its uncertainty is added to that of the edges that are moved. \param
/// every so manieth node of a chain of odometry is a coarse one
CoarseEdges coarse_edges(const GraphParts& graph, std::size_t every);

}  // namespace traverse::pose_graph
