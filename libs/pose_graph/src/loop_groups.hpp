#pragma once

#include <cstddef>
#include <vector>

#include "graph_parts.hpp"
#include "odometry_sums.hpp"

namespace traverse::pose_graph {

/// Loops that confirm each other: both ends of one lie within `reach` nodes of odometry of those of
/// the other, and the circle through both closes within its uncertainty. Who is confirmed by one of
/// a group belongs to it.
/// \param bound on the chi-square of a circle
/// \returns the groups as numbers of edges, the largest first
std::vector<std::vector<std::size_t>> loop_groups(const GraphParts& graph,
                                                  const OdometrySums& odometry, std::size_t reach,
                                                  double bound);

}  // namespace traverse::pose_graph
