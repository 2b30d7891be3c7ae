#pragma once

#include <cstddef>
#include <vector>

#include "graph_parts.hpp"
#include "measured_motion.hpp"

namespace traverse::pose_graph {

/// Odometry between any two nodes of a chain at the price of one: sums along the chains.
class OdometrySums {
 public:
  explicit OdometrySums(const GraphParts& graph);

  bool is_one_chain(std::size_t i, std::size_t j) const { return chain_[i] == chain_[j]; }
  /// T_i_j of two nodes of one chain, in any order.
  geometry::Pose3 motion(std::size_t i, std::size_t j) const;
  /// Of the body twist (rotation, translation) by which that motion may be off, in the axes of j.
  geometry::Matrix6 covariance(std::size_t i, std::size_t j) const;
  /// How far another measurement of that motion is off odometry: 6 degrees of freedom.
  double chi2(std::size_t i, std::size_t j, const MeasuredMotion& other) const;

 private:
  std::vector<std::size_t> chain_;              ///< one a node: the first node of its chain
  std::vector<geometry::Pose3> T_chain_node_;   ///< from there
  std::vector<geometry::Matrix6> covariances_;  ///< of the twists from there on, axes of the first
};

}  // namespace traverse::pose_graph
