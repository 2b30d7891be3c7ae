#include "graph_parts.hpp"

namespace traverse::pose_graph {

std::vector<const Edge*> steps_of(const GraphParts& graph) {
  std::vector<const Edge*> step_to(graph.index_of.size(), nullptr);
  for (const Edge& edge : graph.edges) {
    const std::size_t j = graph.index_of.at(edge.j);
    const bool is_next = graph.index_of.at(edge.i) + 1 == j;
    if (edge.kind == EdgeKind::kOdometry && is_next) step_to[j] = &edge;
  }
  return step_to;
}

}  // namespace traverse::pose_graph
