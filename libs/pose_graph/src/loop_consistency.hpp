#pragma once

#include <vector>

#include "graph_parts.hpp"

namespace traverse::pose_graph {

/// Loops that contradict larger groups of loops, found without solving anything:
///
///     loops that confirm each other make groups (loop_groups)
///     the ways are those of odometry
///     for each group, the largest first, lone loops excepted:
///       if with its loops the ways contradict fewer other loops than it has:
///         its loops become ways, too
///     a loop that the least uncertain way between its ends contradicts is doubted
///
/// where a way is a chain of measured motions, whose covariance is the sum of theirs, and what
/// contradicts has a chi-square of more than four times `bound`, or more where odometry is less
/// certain than it says. That a group of loops is judged by loops outside it is the idea of Latif,
/// Cadena and Neira, "Robust loop closing over time for pose graph SLAM", IJRR 2013; they solve the
/// graph for it.
/// \returns one an edge
std::vector<bool> contradicted_loops(const GraphParts& graph, double bound);

}  // namespace traverse::pose_graph
