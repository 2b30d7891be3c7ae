#include "solve.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <deque>

#include <ceres/problem.h>
#include <ceres/solver.h>
#include <ceres/sphere_manifold.h>

#include "pose_costs.hpp"
#include "scaling_loss.hpp"

namespace traverse::pose_graph {

namespace {

/// A pose as Ceres' parameter blocks.
struct PoseBlocks {
  explicit PoseBlocks(const geometry::Pose3& pose) : q(pose.quaternion()), p(pose.translation) {}
  geometry::Pose3 pose() const { return geometry::Pose3::from_quaternion(q, p); }
  double* rotation() { return q.coeffs().data(); }
  double* translation() { return p.data(); }

  Eigen::Quaterniond q;
  Eigen::Vector3d p;
};

ceres::Problem::Options problem_options() {
  ceres::Problem::Options options;  // GraphProblem owns everything that is in the problem
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  return options;
}

class GraphProblem {
 public:
  GraphProblem(const GraphParts& graph, const GraphOptions& options,
               const std::vector<geometry::Pose3>& poses, const Eigen::Vector3d& up_map)
      : graph_(graph),
        options_(options),
        poses_(poses.begin(), poses.end()),
        up_map_(up_map),
        loop_loss_(chi2_bound(6, options.outlier_probability)),
        fix_loss_(chi2_bound(3, options.outlier_probability)),
        problem_(problem_options()) {
    for (const Edge& edge : graph.edges) add(edge);
    if (graph.is_georeferenced) {
      for (const Fix& fix : graph.fixes) add(fix);
    }
    for (const Level& level : graph.levels) add(level);
    hold_gauge();
  }

  /// The robust bound in units of the final one at which every loop and fix has its full weight.
  double first_widening() const {
    double widening = 1;
    const auto consider = [&](const std::vector<ceres::ResidualBlockId>& blocks,
                              const ScalingLoss& loss) {
      for (const ceres::ResidualBlockId block : blocks) {
        double half_chi2 = 0;
        problem_.EvaluateResidualBlockAssumingParametersUnchanged(block, false, &half_chi2, nullptr,
                                                                  nullptr);
        widening = std::max(widening, 2 * half_chi2 / loss.final_bound());
      }
    };
    consider(loop_blocks_, loop_loss_);
    consider(fix_blocks_, fix_loss_);
    return widening;
  }

  double cost() {
    double cost = 0;
    problem_.Evaluate({}, &cost, nullptr, nullptr, nullptr);
    return cost;
  }

  ceres::Solver::Summary stage(double widening, int iterations) {
    loop_loss_.widen(widening);
    fix_loss_.widen(widening);
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    solver.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
    solver.max_num_iterations = iterations;
    solver.num_threads = 1;  // a fixed order of summation: the same bits on every machine load
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem_, &summary);
    return summary;
  }

  void take_solution(std::vector<geometry::Pose3>& poses, Eigen::Vector3d& up_map) const {
    std::transform(poses_.begin(), poses_.end(), poses.begin(),
                   [](const PoseBlocks& blocks) { return blocks.pose(); });
    up_map = up_map_.normalized();
  }

 private:
  PoseBlocks& at(NodeId node) { return poses_[graph_.index_of.at(node)]; }

  void add(PoseBlocks& pose) {
    problem_.AddParameterBlock(pose.rotation(), 4, &rotation_manifold_);
    problem_.AddParameterBlock(pose.translation(), 3);
  }

  void add(const Edge& edge) {
    PoseBlocks& i = at(edge.i);
    PoseBlocks& j = at(edge.j);
    add(i);
    add(j);
    between_.emplace_back(edge.T_i_j, square_root_information<6>(edge.covariance));
    const bool is_loop = edge.kind == EdgeKind::kLoop;
    const auto block = problem_.AddResidualBlock(
        &between_.back(), is_loop && options_.robust ? &loop_loss_ : nullptr, i.rotation(),
        i.translation(), j.rotation(), j.translation());
    if (is_loop) loop_blocks_.push_back(block);
  }

  void add(const Fix& fix) {
    PoseBlocks& x = at(fix.node);
    add(x);
    antennas_.emplace_back(fix.antenna_enu, fix.antenna_body,
                           square_root_information<3>(fix.covariance));
    fix_blocks_.push_back(problem_.AddResidualBlock(
        &antennas_.back(), options_.robust ? &fix_loss_ : nullptr, x.rotation(), x.translation()));
  }

  void add(const Level& level) {
    PoseBlocks& x = at(level.node);
    add(x);
    problem_.AddParameterBlock(up_map_.data(), 3, &direction_manifold_);
    ups_.emplace_back(level.up_body, level.sigma_rad);
    problem_.AddResidualBlock(&ups_.back(), nullptr, x.rotation(), up_map_.data());
  }

  /// What no measurement tells is held: the first pose, or up in ENU.
  void hold_gauge() {
    if (graph_.is_georeferenced) {
      if (!graph_.levels.empty()) problem_.SetParameterBlockConstant(up_map_.data());
      return;
    }
    PoseBlocks& first = poses_.front();
    add(first);
    problem_.SetParameterBlockConstant(first.rotation());
    problem_.SetParameterBlockConstant(first.translation());
  }

  const GraphParts& graph_;
  const GraphOptions& options_;
  std::vector<PoseBlocks> poses_;
  Eigen::Vector3d up_map_;
  std::deque<BetweenCost> between_;
  std::deque<AntennaCost> antennas_;
  std::deque<GravityCost> ups_;
  ScalingLoss loop_loss_;
  ScalingLoss fix_loss_;
  optimization::RotationManifold rotation_manifold_;
  ceres::SphereManifold<3> direction_manifold_;
  std::vector<ceres::ResidualBlockId> loop_blocks_;
  std::vector<ceres::ResidualBlockId> fix_blocks_;
  ceres::Problem problem_;
};

}  // namespace

double chi2_bound(int rows, double probability) {
  return boost::math::quantile(
      boost::math::complement(boost::math::chi_squared(rows), probability));
}

Result solve(const GraphParts& graph, const GraphOptions& options,
             std::vector<geometry::Pose3>& poses, Eigen::Vector3d& up_map) {
  GraphProblem problem(graph, options, poses, up_map);
  Result result;
  result.initial_cost = problem.cost();
  const auto count = [&](const ceres::Solver::Summary& summary) {
    ++result.stages;
    result.iterations += static_cast<int>(summary.iterations.size()) - 1;
  };
  if (options.robust) {
    for (double widening = problem.first_widening(); widening > 1; widening /= options.graduation) {
      count(problem.stage(widening, options.steps_a_stage));
    }
  }
  const ceres::Solver::Summary summary = problem.stage(1, options.most_iterations);
  count(summary);
  result.final_cost = summary.final_cost;
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  result.message = summary.message;
  problem.take_solution(poses, up_map);
  return result;
}

}  // namespace traverse::pose_graph
