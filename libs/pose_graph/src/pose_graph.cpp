#include "traverse/pose_graph/pose_graph.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/Dense>
#include <fmt/core.h>

#include "traverse/statistics/quantile.hpp"

#include "level_alignment.hpp"
#include "residuals.hpp"
#include "scaling_loss.hpp"
#include "solve.hpp"

namespace traverse::pose_graph {

namespace {

template <typename Matrix>
void require_covariance(const Matrix& covariance, const std::string& of) {
  const bool is_symmetric =
      covariance.allFinite() && covariance.isApprox(covariance.transpose(), 1e-9);
  if (!is_symmetric || Eigen::LLT<Matrix>(covariance).info() != Eigen::Success) {
    throw std::invalid_argument("the covariance of " + of + " is not positive definite");
  }
}

template <typename Vector, typename Matrix>
double chi2_of(const Vector& residual, const Matrix& covariance) {
  return residual.dot(Eigen::LLT<Matrix>(covariance).solve(residual));
}

}  // namespace

PoseGraph::PoseGraph(const GraphOptions& options) : options_(options) {}

std::size_t PoseGraph::index(NodeId id) const {
  const auto found = index_of_.find(id);
  if (found == index_of_.end()) {
    throw std::invalid_argument(fmt::format("the pose graph has no node {}", id));
  }
  return found->second;
}

void PoseGraph::add_node(NodeId id, const geometry::Pose3& T_map_body_guess) {
  if (!index_of_.emplace(id, ids_.size()).second) {
    throw std::invalid_argument(fmt::format("the pose graph has a node {} already", id));
  }
  ids_.push_back(id);
  guesses_.push_back(T_map_body_guess);
  poses_.push_back(T_map_body_guess);
  if (solved_nodes_ > 0) place(ids_.size() - 1, ids_.size() - 2);
}

void PoseGraph::place(std::size_t node, std::size_t beside) {
  poses_[node] = poses_[beside] * guesses_[beside].inverse() * guesses_[node];
}

void PoseGraph::add_between(NodeId i, NodeId j, const geometry::Pose3& T_i_j,
                            const geometry::Matrix6& covariance, EdgeKind kind) {
  const std::size_t from = index(i);
  const std::size_t to = index(j);
  const std::string name = fmt::format("the edge from node {} to node {}", i, j);
  if (from == to) throw std::invalid_argument(name + " goes nowhere");
  require_covariance(covariance, name);
  Edge edge;
  edge.i = i;
  edge.j = j;
  edge.kind = kind;
  edge.T_i_j = T_i_j;
  edge.covariance = covariance;
  edges_.push_back(edge);
  const bool is_solved = to < solved_nodes_ || solved_nodes_ == 0;
  if (kind == EdgeKind::kOdometry && !is_solved && from < to) place(to, from);
}

void PoseGraph::add_gnss(NodeId i, const Eigen::Vector3d& antenna_enu,
                         const Eigen::Matrix3d& covariance, const Eigen::Vector3d& antenna_body) {
  index(i);
  require_covariance(covariance, fmt::format("the fix of node {}", i));
  Fix fix;
  fix.node = i;
  fix.antenna_enu = antenna_enu;
  fix.covariance = covariance;
  fix.antenna_body = antenna_body;
  fixes_.push_back(fix);
}

void PoseGraph::add_gravity(NodeId i, const Eigen::Vector3d& up_body, double sigma_rad) {
  index(i);
  if (!(up_body.norm() > 0) || !up_body.allFinite() || !(sigma_rad > 0)) {
    throw std::invalid_argument(
        fmt::format("up at node {} needs a direction and a positive sigma", i));
  }
  levels_.push_back({i, up_body.normalized(), sigma_rad});
}

Result PoseGraph::optimise(Start start) {
  Result result;
  if (ids_.empty()) {
    result.is_usable = true;
    result.converged = true;
    result.reason = optimization::Termination::kConverged;
    result.message = "there is no node";
    return result;
  }
  PoseGraph before = *this;
  if (start == Start::kGuesses) forget_solution();
  if (!is_georeferenced_) {
    find_up();
    georeference();
  }
  const double initial_cost = evaluate();
  Doubts doubts{std::vector<bool>(edges_.size(), false), std::vector<bool>(fixes_.size(), false),
                std::vector<bool>(levels_.size(), false)};
  for (std::size_t e = 0; e < judged_edges_; ++e) doubts.edges[e] = edges_[e].is_rejected();
  for (std::size_t f = 0; f < judged_fixes_; ++f) doubts.fixes[f] = fixes_[f].is_rejected();
  for (std::size_t l = 0; l < judged_levels_; ++l) doubts.levels[l] = levels_[l].is_rejected();
  const GraphParts parts{edges_, fixes_, levels_, index_of_, is_georeferenced_};
  result = solve(parts, std::move(doubts), options_, {poses_, up_map_, up_offset_});
  result.initial_cost = initial_cost;
  if (result.is_usable) {
    result.final_cost = evaluate();
    solved_nodes_ = ids_.size();
    judged_edges_ = edges_.size();
    judged_fixes_ = is_georeferenced_ ? fixes_.size() : 0;
    judged_levels_ = levels_.size();
  } else {
    result.final_cost = initial_cost;
    *this = std::move(before);
  }

  const auto is_rejected = [](const auto& measured) { return measured.is_rejected(); };
  const auto count = [](const auto& list, const auto& condition) {
    return static_cast<std::size_t>(std::count_if(list.begin(), list.end(), condition));
  };
  result.loops = count(edges_, [](const Edge& edge) { return edge.kind == EdgeKind::kLoop; });
  result.rejected_loops = count(edges_, is_rejected);
  result.fixes = fixes_.size();
  result.rejected_fixes = is_georeferenced_ ? count(fixes_, is_rejected) : 0;
  result.levels = levels_.size();
  result.rejected_levels = count(levels_, is_rejected);
  result.is_georeferenced = is_georeferenced_;
  return result;
}

void PoseGraph::forget_solution() {
  poses_ = guesses_;
  solved_nodes_ = 0;
  judged_edges_ = 0;
  judged_fixes_ = 0;
  judged_levels_ = 0;
  up_offset_.setZero();
  is_georeferenced_ = false;
}

void PoseGraph::find_up() {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Level& level : levels_) sum += pose(level.node).rotation * level.up_body;
  if (levels_.empty()) {  // a vehicle stands upright on the average
    for (const geometry::Pose3& T_map_body : poses_) sum += T_map_body.rotation.col(2);
  }
  if (sum.norm() > 0) up_map_ = sum.normalized();
}

void PoseGraph::georeference() {
  if (fixes_.size() < 2) return;
  std::vector<Eigen::Vector3d> antennas_map, antennas_enu;
  std::vector<double> sigmas;
  for (const Fix& fix : fixes_) {
    antennas_map.push_back(pose(fix.node) * fix.antenna_body);
    antennas_enu.push_back(fix.antenna_enu);
    sigmas.push_back(std::sqrt(fix.covariance.topLeftCorner<2, 2>().trace() / 2));
  }
  const double spread = options_.min_fix_spread * statistics::element_at_share(sigmas, 0.5);
  const auto T_enu_map = level_alignment(antennas_map, antennas_enu, up_map_, spread);
  if (!T_enu_map) return;
  for (geometry::Pose3& T_map_body : poses_) T_map_body = *T_enu_map * T_map_body;
  up_map_ = Eigen::Vector3d::UnitZ();
  is_georeferenced_ = true;
}

double PoseGraph::evaluate() {
  const double loop_bound = chi2_bound(6, options_.outlier_probability);
  const double fix_bound = chi2_bound(3, options_.outlier_probability);
  const double level_bound = chi2_bound(2, options_.outlier_probability);
  double sum = 0;
  for (Edge& edge : edges_) {
    edge.residual = between_residual(edge.T_i_j, pose(edge.i), pose(edge.j));
    edge.chi2 = chi2_of(edge.residual, edge.covariance);
    const bool is_doubtful = options_.robust && edge.kind == EdgeKind::kLoop;
    edge.weight = is_doubtful ? scaling_weight(edge.chi2, loop_bound) : 1;
    sum += is_doubtful ? scaled_cost(edge.chi2, loop_bound) : edge.chi2;
  }
  for (Fix& fix : fixes_) {
    if (!is_georeferenced_) break;
    fix.residual = antenna_residual(fix.antenna_enu, fix.antenna_body, pose(fix.node));
    fix.chi2 = chi2_of(fix.residual, fix.covariance);
    fix.weight = options_.robust ? scaling_weight(fix.chi2, fix_bound) : 1;
    sum += options_.robust ? scaled_cost(fix.chi2, fix_bound) : fix.chi2;
  }
  for (Level& level : levels_) {
    const Residual<3> r = gravity_residual(level.up_body, pose(level.node), up_map_, up_offset_);
    level.angle_rad = 2 * std::asin(std::min(1.0, r.norm() / 2));  // of its chord
    level.chi2 = r.squaredNorm() / (level.sigma_rad * level.sigma_rad);
    level.weight = options_.robust ? scaling_weight(level.chi2, level_bound) : 1;
    sum += options_.robust ? scaled_cost(level.chi2, level_bound) : level.chi2;
  }
  if (options_.up_offset_deg > 0) {
    sum += up_offset_.squaredNorm() / std::pow(up_offset_sigma(options_), 2);
  }
  return sum / 2;
}

std::map<NodeId, geometry::Pose3> PoseGraph::poses() const {
  std::map<NodeId, geometry::Pose3> result;
  for (const auto& [id, place_in_list] : index_of_) result.emplace(id, poses_[place_in_list]);
  return result;
}

const geometry::Pose3& PoseGraph::pose(NodeId id) const { return poses_[index(id)]; }

std::optional<Eigen::Vector3d> PoseGraph::up_map() const {
  if (is_georeferenced_ || (solved_nodes_ > 0 && !levels_.empty())) return up_map_;
  return std::nullopt;
}

}  // namespace traverse::pose_graph
