#pragma once

#include <cstddef>
#include <vector>

#include "graph_parts.hpp"
#include "measured_motion.hpp"

namespace traverse::pose_graph {

/// The least uncertain ways between all nodes of a small graph, through measured motions.
class LeastUncertainWays {
 public:
  explicit LeastUncertainWays(std::size_t nodes) : links_(nodes) {}

  void add(std::size_t i, std::size_t j, const MeasuredMotion& motion);
  /// To be called after the last add(): Dijkstra from every node.
  void find();

  /// How far a motion is off the way between its ends: 6 degrees of freedom, 0 where there is none.
  double chi2(std::size_t i, std::size_t j, const MeasuredMotion& motion) const;

 private:
  struct Link {
    std::size_t to;
    double uncertainty;
    MeasuredMotion motion;
  };
  struct Way {
    bool is_found = false;
    MeasuredMotion motion;
  };
  std::vector<Way> ways_from(std::size_t node) const;

  std::vector<std::vector<Link>> links_;
  std::vector<std::vector<Way>> ways_;  ///< [from][to]
};

}  // namespace traverse::pose_graph
