#include "loop_consistency.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "traverse/statistics/quantile.hpp"

#include "coarse_edges.hpp"
#include "least_uncertain_ways.hpp"
#include "loop_groups.hpp"
#include "odometry_sums.hpp"

namespace traverse::pose_graph {

namespace {

constexpr std::size_t kCoarseNodes = 100;
constexpr std::size_t kLeastReach = 10;  // nodes
constexpr std::size_t kMostGroups = 40;
// Of the bound: what is nearer is for the solution to judge.
constexpr double kContradiction = 4;
// Of chi-square with six degrees of freedom.
constexpr double kLowerQuartile = 3.455;

/// What the ways through a graph say of its loops.
class LoopJudge {
 public:
  LoopJudge(const GraphParts& graph, std::size_t every)
      : graph_(graph), coarse_(coarse_edges(graph, every)), odometry_(graph) {
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
      if (graph.edges[e].kind == EdgeKind::kLoop) loops_.push_back(e);
    }
  }

  const OdometrySums& odometry() const { return odometry_; }
  const std::vector<std::size_t>& loops() const { return loops_; }

  LeastUncertainWays ways_of_odometry() const {
    LeastUncertainWays ways(coarse_.nodes);
    for (std::size_t e = 0; e < graph_.edges.size(); ++e) {
      if (graph_.edges[e].kind == EdgeKind::kOdometry) add(ways, e);
    }
    ways.find();
    return ways;
  }

  LeastUncertainWays with(LeastUncertainWays ways, const std::vector<std::size_t>& loops) const {
    for (const std::size_t e : loops) add(ways, e);
    ways.find();
    return ways;
  }

  double chi2(const LeastUncertainWays& ways, std::size_t e) const {
    if (const auto& moved = coarse_.edges[e]) return ways.chi2(moved->i, moved->j, moved->motion);
    const Edge& edge = graph_.edges[e];  // within one coarse node odometry is way enough
    return odometry_.chi2(graph_.index_of.at(edge.i), graph_.index_of.at(edge.j),
                          {edge.T_i_j, edge.covariance});
  }

  std::vector<bool> beyond(double most, const LeastUncertainWays& ways) const {
    std::vector<bool> flags(graph_.edges.size(), false);
    for (const std::size_t e : loops_) flags[e] = chi2(ways, e) > most;
    return flags;
  }

  /// By how much chi-squares beside odometry are larger than they should be. Odometry that errs by
  /// more than it knows contradicts true loops, too.
  double excess(const LeastUncertainWays& ways) const {
    std::vector<double> off;
    for (const std::size_t e : loops_) off.push_back(chi2(ways, e));
    return std::max(1.0, statistics::element_at_share(off, 0.25) / kLowerQuartile);
  }

 private:
  void add(LeastUncertainWays& ways, std::size_t e) const {
    if (const auto& moved = coarse_.edges[e]) ways.add(moved->i, moved->j, moved->motion);
  }

  const GraphParts& graph_;
  CoarseEdges coarse_;
  OdometrySums odometry_;
  std::vector<std::size_t> loops_;
};

std::size_t count(const std::vector<bool>& flags) {
  return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), true));
}

}  // namespace

std::vector<bool> contradicted_loops(const GraphParts& graph, double bound) {
  const std::size_t every = std::max<std::size_t>(1, graph.index_of.size() / kCoarseNodes);
  const LoopJudge judge(graph, every);
  if (judge.loops().empty()) return std::vector<bool>(graph.edges.size(), false);
  const auto groups = loop_groups(graph, judge.odometry(), std::max(kLeastReach, every / 2),
                                  kContradiction * bound);

  LeastUncertainWays ways = judge.ways_of_odometry();
  const double most = kContradiction * bound * judge.excess(ways);
  std::vector<bool> contradicted = judge.beyond(most, ways);
  for (std::size_t g = 0; g < std::min(groups.size(), kMostGroups); ++g) {
    std::vector<std::size_t> fitting;
    std::copy_if(groups[g].begin(), groups[g].end(), std::back_inserter(fitting),
                 [&](std::size_t e) { return !contradicted[e]; });
    if (fitting.size() < 2) continue;
    LeastUncertainWays more = judge.with(ways, fitting);
    std::vector<bool> then = judge.beyond(most, more);
    if (count(then) >= count(contradicted) + fitting.size()) continue;
    ways = std::move(more);
    contradicted = std::move(then);
  }
  return contradicted;
}

}  // namespace traverse::pose_graph
