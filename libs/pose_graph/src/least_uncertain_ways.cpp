#include "least_uncertain_ways.hpp"

#include <limits>
#include <queue>
#include <utility>

#include <Eigen/Dense>

#include "traverse/geometry/so3.hpp"

namespace traverse::pose_graph {

namespace {

// A turn moves what is this far away; so both parts of an uncertainty are squared metres.
constexpr double kLever_m = 100;

double uncertainty_of(const MeasuredMotion& motion) {
  const auto& covariance = motion.covariance;
  return kLever_m * kLever_m * covariance.topLeftCorner<3, 3>().trace() +
         covariance.bottomRightCorner<3, 3>().trace();
}

}  // namespace

void LeastUncertainWays::add(std::size_t i, std::size_t j, const MeasuredMotion& motion) {
  const double uncertainty = uncertainty_of(motion);
  links_[i].push_back({j, uncertainty, motion});
  links_[j].push_back({i, uncertainty, motion.inverse()});
}

void LeastUncertainWays::find() {
  ways_.clear();
  for (std::size_t k = 0; k < links_.size(); ++k) ways_.push_back(ways_from(k));
}

std::vector<LeastUncertainWays::Way> LeastUncertainWays::ways_from(std::size_t node) const {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<double> best(links_.size(), kFar);
  std::vector<std::pair<std::size_t, const Link*>> last(links_.size(), {node, nullptr});
  std::vector<Way> ways(links_.size());
  using Reached = std::pair<double, std::size_t>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  best[node] = 0;
  open.emplace(0, node);
  while (!open.empty()) {
    const auto [uncertainty, at] = open.top();
    open.pop();
    if (ways[at].is_found) continue;
    const auto [before, link] = last[at];
    ways[at] = {true, link == nullptr ? MeasuredMotion{} : ways[before].motion * link->motion};
    for (const Link& next : links_[at]) {
      const double sum = uncertainty + next.uncertainty;
      if (sum >= best[next.to]) continue;
      best[next.to] = sum;
      last[next.to] = {at, &next};
      open.emplace(sum, next.to);
    }
  }
  return ways;
}

double LeastUncertainWays::chi2(std::size_t i, std::size_t j, const MeasuredMotion& motion) const {
  const Way& way = ways_[i][j];
  if (!way.is_found) return 0;
  geometry::Twist off;
  off << geometry::log_so3(motion.T_i_j.rotation.transpose() * way.motion.T_i_j.rotation),
      way.motion.T_i_j.translation - motion.T_i_j.translation;
  const geometry::Matrix6 covariance = motion.covariance + way.motion.covariance;
  return off.dot(covariance.ldlt().solve(off));
}

}  // namespace traverse::pose_graph
