#include "solve.hpp"

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <deque>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include <ceres/normal_prior.h>
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
  options.enable_fast_removal = true;
  return options;
}

/// A constraint that may be false. Far beyond the bound it is left out of the problem, because a
/// link between distant places makes the equations dense even when it weighs nothing.
struct DoubtfulFactor {
  ceres::CostFunction* cost;
  ScalingLoss* loss;
  std::vector<double*> parameters;
  bool was_rejected = false;
  ceres::ResidualBlockId block = nullptr;  ///< in the problem, or null

  double chi2() const {
    std::array<double, 6> r{};
    cost->Evaluate(parameters.data(), r.data(), nullptr);
    return std::inner_product(r.begin(), r.end(), r.begin(), 0.0);
  }
};

class GraphProblem {
 public:
  GraphProblem(const GraphParts& graph, const GraphOptions& options, const GraphState& state)
      : graph_(graph),
        options_(options),
        poses_(state.poses.begin(), state.poses.end()),
        up_map_(state.up_map),
        up_offset_(state.up_offset),
        loop_loss_(chi2_bound(6, options.outlier_probability)),
        fix_loss_(chi2_bound(3, options.outlier_probability)),
        level_loss_(chi2_bound(2, options.outlier_probability)),
        problem_(problem_options()) {
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
      const Edge& edge = graph.edges[e];
      add(edge, e < graph.judged_edges && edge.is_rejected());
    }
    for (std::size_t f = 0; f < graph.fixes.size() && graph.is_georeferenced; ++f) {
      const Fix& fix = graph.fixes[f];
      add(fix, f < graph.judged_fixes && fix.is_rejected());
    }
    for (std::size_t l = 0; l < graph.levels.size(); ++l) {
      const Level& level = graph.levels[l];
      add(level, l < graph.judged_levels && level.is_rejected());
    }
    if (!graph.levels.empty()) add_offset();
    hold_gauge();
  }

  /// The bound in units of the final one at which every new loop and fix has its full weight.
  double first_widening() const {
    double widening = 1;
    for (const DoubtfulFactor& factor : doubtful_) {
      if (factor.was_rejected) continue;
      widening = std::max(widening, factor.chi2() / factor.loss->final_bound());
    }
    return widening;
  }

  ceres::Solver::Summary stage(double widening, int iterations) {
    loop_loss_.widen(widening);
    fix_loss_.widen(widening);
    level_loss_.widen(widening);
    take_in_or_leave_out();
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    solver.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
    solver.max_num_iterations = iterations;
    // A long chain bends far at little cost: damping would hide that from the first steps.
    solver.initial_trust_region_radius = 1e12;
    solver.function_tolerance = 1e-8;
    solver.num_threads = 1;  // a fixed order of summation: the same bits on every machine load
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem_, &summary);
    return summary;
  }

  /// By the present poses and bound; whether that changed anything.
  bool take_in_or_leave_out() {
    constexpr double kLeast = 1e-6;  // weight: a thousandth of a standard deviation's pull
    bool is_changed = false;
    for (DoubtfulFactor& factor : doubtful_) {
      const bool counts = scaling_weight(factor.chi2(), factor.loss->bound()) > kLeast;
      if (counts == (factor.block != nullptr)) continue;
      is_changed = true;
      if (counts) {
        factor.block = problem_.AddResidualBlock(factor.cost, factor.loss, factor.parameters);
      } else {
        problem_.RemoveResidualBlock(factor.block);
        factor.block = nullptr;
      }
    }
    return is_changed;
  }

  void take_solution(const GraphState& state) const {
    std::transform(poses_.begin(), poses_.end(), state.poses.begin(),
                   [](const PoseBlocks& blocks) { return blocks.pose(); });
    state.up_map = up_map_.normalized();
    state.up_offset = up_offset_;
  }

 private:
  PoseBlocks& at(NodeId node) { return poses_[graph_.index_of.at(node)]; }

  void add(PoseBlocks& pose) {
    problem_.AddParameterBlock(pose.rotation(), 4, &rotation_manifold_);
    problem_.AddParameterBlock(pose.translation(), 3);
  }

  void add(const Edge& edge, bool was_rejected) {
    PoseBlocks& i = at(edge.i);
    PoseBlocks& j = at(edge.j);
    add(i);
    add(j);
    between_.emplace_back(edge.T_i_j, square_root_information<6>(edge.covariance));
    const bool is_doubtful = options_.robust && edge.kind == EdgeKind::kLoop;
    add(&between_.back(), is_doubtful ? &loop_loss_ : nullptr,
        {i.rotation(), i.translation(), j.rotation(), j.translation()}, was_rejected);
  }

  void add(const Fix& fix, bool was_rejected) {
    PoseBlocks& x = at(fix.node);
    add(x);
    antennas_.emplace_back(fix.antenna_enu, fix.antenna_body,
                           square_root_information<3>(fix.covariance));
    add(&antennas_.back(), options_.robust ? &fix_loss_ : nullptr, {x.rotation(), x.translation()},
        was_rejected);
  }

  void add(const Level& level, bool was_rejected) {
    PoseBlocks& x = at(level.node);
    add(x);
    problem_.AddParameterBlock(up_map_.data(), 3, &direction_manifold_);
    problem_.AddParameterBlock(up_offset_.data(), 3);
    ups_.emplace_back(level.up_body, level.sigma_rad);
    add(&ups_.back(), options_.robust ? &level_loss_ : nullptr,
        {x.rotation(), up_map_.data(), up_offset_.data()}, was_rejected);
  }

  void add_offset() {
    const double sigma = up_offset_sigma(options_);
    if (sigma == 0) {
      problem_.SetParameterBlockConstant(up_offset_.data());
      return;
    }
    offset_prior_.emplace(ceres::Matrix(ceres::Matrix::Identity(3, 3) / sigma),
                          ceres::Vector(ceres::Vector::Zero(3)));
    problem_.AddResidualBlock(&*offset_prior_, nullptr, up_offset_.data());
  }

  void add(ceres::CostFunction* cost, ScalingLoss* loss, std::vector<double*> parameters,
           bool was_rejected) {
    if (loss == nullptr) {
      problem_.AddResidualBlock(cost, nullptr, parameters);
    } else {
      doubtful_.push_back({cost, loss, std::move(parameters), was_rejected});
    }
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
  Eigen::Vector3d up_map_, up_offset_;
  std::deque<BetweenCost> between_;
  std::deque<AntennaCost> antennas_;
  std::deque<GravityCost> ups_;
  std::optional<ceres::NormalPrior> offset_prior_;
  std::vector<DoubtfulFactor> doubtful_;
  ScalingLoss loop_loss_;
  ScalingLoss fix_loss_;
  ScalingLoss level_loss_;
  optimization::RotationManifold rotation_manifold_;
  ceres::SphereManifold<3> direction_manifold_;
  ceres::Problem problem_;
};

}  // namespace

double chi2_bound(int rows, double probability) {
  return boost::math::quantile(
      boost::math::complement(boost::math::chi_squared(rows), probability));
}

double up_offset_sigma(const GraphOptions& options) {
  return options.up_offset_deg * std::numbers::pi / 180;
}

Result solve(const GraphParts& graph, const GraphOptions& options, const GraphState& state) {
  GraphProblem problem(graph, options, state);
  Result result;
  const auto count = [&](const ceres::Solver::Summary& summary) {
    ++result.stages;
    result.iterations += static_cast<int>(summary.iterations.size()) - 1;
  };
  if (options.robust) {
    for (double widening = problem.first_widening(); widening > 1; widening /= options.graduation) {
      count(problem.stage(widening, options.steps_a_stage));
    }
  }
  ceres::Solver::Summary summary;
  do {
    summary = problem.stage(1, options.most_iterations);
    count(summary);
  } while (problem.take_in_or_leave_out() && result.iterations < 4 * options.most_iterations);
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  result.message = summary.message;
  problem.take_solution(state);
  return result;
}

}  // namespace traverse::pose_graph
