#include "loop_groups.hpp"

#include <algorithm>
#include <numeric>

#include <Eigen/Dense>

#include "traverse/geometry/se3.hpp"

#include "measured_motion.hpp"

namespace traverse::pose_graph {

namespace {

using geometry::adjoint;
using geometry::Matrix6;
using geometry::Pose3;

// Loops behind a loop that are near at both ends and are asked to confirm it.
constexpr int kAsked = 4;

struct Loop {
  std::size_t edge;
  std::size_t i, j;
  MeasuredMotion motion;
};

std::vector<Loop> loops_by_end(const GraphParts& graph) {
  std::vector<Loop> loops;
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    const Edge& edge = graph.edges[e];
    if (edge.kind != EdgeKind::kLoop) continue;
    loops.push_back(
        {e, graph.index_of.at(edge.i), graph.index_of.at(edge.j), {edge.T_i_j, edge.covariance}});
  }
  std::stable_sort(loops.begin(), loops.end(),
                   [](const Loop& a, const Loop& b) { return a.j < b.j; });
  return loops;
}

std::size_t between(std::size_t a, std::size_t b) { return a < b ? b - a : a - b; }

/// Of the circle from j of `a` back to i, to i of `b`, across to its j and back along odometry.
double circle_chi2(const Loop& a, const Loop& b, const OdometrySums& odometry) {
  const Pose3 T_ja_ia = a.motion.T_i_j.inverse();
  const Pose3 T_jb_ja = odometry.motion(b.j, a.j);
  const Pose3 circle = T_ja_ia * odometry.motion(a.i, b.i) * b.motion.T_i_j * T_jb_ja;
  const Matrix6 from_ib = adjoint(b.motion.T_i_j.inverse());
  const Matrix6 from_jb = adjoint(T_jb_ja.inverse());
  const Matrix6 at_jb =
      from_ib * odometry.covariance(a.i, b.i) * from_ib.transpose() + b.motion.twist_covariance();
  const Matrix6 covariance = a.motion.twist_covariance() + odometry.covariance(b.j, a.j) +
                             from_jb * at_jb * from_jb.transpose();
  const geometry::Twist off = geometry::log_se3(circle);
  return off.dot(covariance.ldlt().solve(off));
}

std::size_t root_of(std::vector<std::size_t>& parent, std::size_t k) {
  while (parent[k] != k) k = parent[k] = parent[parent[k]];
  return k;
}

}  // namespace

std::vector<std::vector<std::size_t>> loop_groups(const GraphParts& graph,
                                                  const OdometrySums& odometry, std::size_t reach,
                                                  double bound) {
  const std::vector<Loop> loops = loops_by_end(graph);
  std::vector<std::size_t> parent(loops.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  for (std::size_t a = 0; a < loops.size(); ++a) {
    int asked = 0;
    for (std::size_t b = a + 1; b < loops.size() && asked < kAsked; ++b) {
      if (loops[b].j > loops[a].j + reach) break;
      if (between(loops[a].i, loops[b].i) > reach) continue;
      if (!odometry.is_one_chain(loops[a].i, loops[b].i)) continue;
      if (!odometry.is_one_chain(loops[a].j, loops[b].j)) continue;
      ++asked;
      if (circle_chi2(loops[a], loops[b], odometry) > bound) continue;
      parent[root_of(parent, b)] = root_of(parent, a);
    }
  }
  std::vector<std::vector<std::size_t>> groups(loops.size());
  for (std::size_t k = 0; k < loops.size(); ++k) {
    groups[root_of(parent, k)].push_back(loops[k].edge);
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  while (!groups.empty() && groups.back().empty()) groups.pop_back();
  return groups;
}

}  // namespace traverse::pose_graph
