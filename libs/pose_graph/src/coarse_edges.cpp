#include "coarse_edges.hpp"

namespace traverse::pose_graph {

namespace {

/// How a node is carried along.
struct Carried {
  std::size_t by = 0;     ///< a coarse node
  std::size_t steps = 0;  ///< of odometry from there
  MeasuredMotion motion;  ///< from there
};

std::vector<Carried> carried_nodes(const GraphParts& graph, std::size_t every,
                                   std::size_t& coarse_nodes) {
  std::vector<Carried> nodes;
  coarse_nodes = 0;
  for (const Edge* step : steps_of(graph)) {
    if (step == nullptr || nodes.back().steps + 1 == every) {
      nodes.push_back({coarse_nodes++, 0, {}});
    } else {
      const Carried& before = nodes.back();
      const MeasuredMotion motion = before.motion * MeasuredMotion{step->T_i_j, step->covariance};
      nodes.push_back({before.by, before.steps + 1, motion});
    }
  }
  return nodes;
}

}  // namespace

CoarseEdges coarse_edges(const GraphParts& graph, std::size_t every) {
  CoarseEdges coarse;
  const std::vector<Carried> nodes = carried_nodes(graph, every, coarse.nodes);
  for (const Edge& edge : graph.edges) {
    const Carried& i = nodes[graph.index_of.at(edge.i)];
    const Carried& j = nodes[graph.index_of.at(edge.j)];
    auto& moved = coarse.edges.emplace_back();
    if (i.by == j.by) continue;
    moved = {i.by, j.by,
             i.motion * MeasuredMotion{edge.T_i_j, edge.covariance} * j.motion.inverse()};
  }
  return coarse;
}

}  // namespace traverse::pose_graph
