#include "graph_problem.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "solve.hpp"

namespace traverse::pose_graph {

namespace {

// The weight below which a measurement is left out: a thousandth of a standard deviation's pull.
constexpr double kLeast = 1e-6;

// Radii of the trust region. A long chain bends far at little cost: damping would hide that from
// the first steps. A stage goes on with less than the stage before needed in the end.
constexpr double kHardlyDamped = 1e12;
constexpr double kLessDamped = 100;
constexpr int kTriesAStep = 6;

/// Ends a solution after so many steps that lessened the cost.
class StepLimit final : public ceres::IterationCallback {
 public:
  explicit StepLimit(int steps) : left_(steps) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& iteration) override {
    if (iteration.iteration > 0 && iteration.step_is_successful) --left_;
    return left_ > 0 ? ceres::SOLVER_CONTINUE : ceres::SOLVER_TERMINATE_SUCCESSFULLY;
  }

 private:
  int left_;
};

ceres::Problem::Options problem_options() {
  ceres::Problem::Options options;  // GraphProblem owns everything that is in the problem
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.enable_fast_removal = true;
  return options;
}

}  // namespace

GraphProblem::GraphProblem(const GraphParts& graph, const Doubts& doubts,
                           const GraphOptions& options, const GraphState& state)
    : graph_(graph),
      options_(options),
      poses_(state.poses.begin(), state.poses.end()),
      up_map_(state.up_map),
      up_offset_(state.up_offset),
      loop_loss_(chi2_bound(6, options.outlier_probability)),
      fix_loss_(chi2_bound(3, options.outlier_probability)),
      level_loss_(chi2_bound(2, options.outlier_probability)),
      problem_(problem_options()) {
  for (std::size_t e = 0; e < graph.edges.size(); ++e) add(graph.edges[e], doubts.edges[e]);
  for (std::size_t f = 0; f < graph.fixes.size() && graph.is_georeferenced; ++f) {
    add(graph.fixes[f], doubts.fixes[f]);
  }
  for (std::size_t l = 0; l < graph.levels.size(); ++l) add(graph.levels[l], doubts.levels[l]);
  if (!graph.levels.empty()) add_offset();
  hold_gauge();
}

double GraphProblem::DoubtfulFactor::chi2() const {
  std::array<double, 6> r{};
  cost->Evaluate(parameters.data(), r.data(), nullptr);
  return std::inner_product(r.begin(), r.end(), r.begin(), 0.0);
}

double GraphProblem::widest() const {
  double widening = 1;
  for (const DoubtfulFactor& factor : doubtful_) {
    if (factor.is_doubted) continue;
    widening = std::max(widening, factor.chi2() / factor.loss->final_bound());
  }
  return widening;
}

optimization::Solution GraphProblem::stage(double widening, int steps) {
  return solve(widening, steps, kTriesAStep * steps,
               std::min(kHardlyDamped, kLessDamped * radius_));
}

optimization::Solution GraphProblem::finish(int iterations) {
  return solve(1, iterations, iterations, kHardlyDamped);
}

optimization::Solution GraphProblem::solve(double widening, int steps, int iterations,
                                           double radius) {
  loop_loss_.widen(widening);
  fix_loss_.widen(widening);
  level_loss_.widen(widening);
  take_in_or_leave_out();
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  solver.max_num_iterations = iterations;
  solver.initial_trust_region_radius = radius;
  solver.function_tolerance = 1e-6;
  solver.num_threads = 1;  // a fixed order of summation: the same bits on every machine load
  solver.logging_type = ceres::SILENT;
  StepLimit limit(steps);
  solver.callbacks.push_back(&limit);
  optimization::Solution solution = optimization::solve(solver, problem_);
  radius_ = solution.trust_region_radius.value_or(radius_);
  return solution;
}

bool GraphProblem::take_in_or_leave_out() {
  bool is_changed = false;
  for (DoubtfulFactor& factor : doubtful_) {
    const bool is_wide = factor.loss->bound() > factor.loss->final_bound();
    const bool counts = !(is_wide && factor.is_doubted) &&
                        scaling_weight(factor.chi2(), factor.loss->bound()) > kLeast;
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

void GraphProblem::take_solution(const GraphState& state) const {
  std::transform(poses_.begin(), poses_.end(), state.poses.begin(),
                 [](const PoseBlocks& blocks) { return blocks.pose(); });
  state.up_map = up_map_.normalized();
  state.up_offset = up_offset_;
}

void GraphProblem::add(PoseBlocks& pose) {
  problem_.AddParameterBlock(pose.rotation(), 4, &rotation_manifold_);
  problem_.AddParameterBlock(pose.translation(), 3);
}

void GraphProblem::add(const Edge& edge, bool is_doubted) {
  PoseBlocks& i = at(edge.i);
  PoseBlocks& j = at(edge.j);
  add(i);
  add(j);
  between_.emplace_back(edge.T_i_j, square_root_information<6>(edge.covariance));
  const bool may_be_false = options_.robust && edge.kind == EdgeKind::kLoop;
  add(&between_.back(), may_be_false ? &loop_loss_ : nullptr,
      {i.rotation(), i.translation(), j.rotation(), j.translation()}, is_doubted);
}

void GraphProblem::add(const Fix& fix, bool is_doubted) {
  PoseBlocks& x = at(fix.node);
  add(x);
  antennas_.emplace_back(fix.antenna_enu, fix.antenna_body,
                         square_root_information<3>(fix.covariance));
  add(&antennas_.back(), options_.robust ? &fix_loss_ : nullptr, {x.rotation(), x.translation()},
      is_doubted);
}

void GraphProblem::add(const Level& level, bool is_doubted) {
  PoseBlocks& x = at(level.node);
  add(x);
  problem_.AddParameterBlock(up_map_.data(), 3, &direction_manifold_);
  problem_.AddParameterBlock(up_offset_.data(), 3);
  ups_.emplace_back(level.up_body, level.sigma_rad);
  add(&ups_.back(), options_.robust ? &level_loss_ : nullptr,
      {x.rotation(), up_map_.data(), up_offset_.data()}, is_doubted);
}

void GraphProblem::add_offset() {
  const double sigma = up_offset_sigma(options_);
  if (sigma == 0) {
    problem_.SetParameterBlockConstant(up_offset_.data());
    return;
  }
  offset_prior_.emplace(ceres::Matrix(ceres::Matrix::Identity(3, 3) / sigma),
                        ceres::Vector(ceres::Vector::Zero(3)));
  problem_.AddResidualBlock(&*offset_prior_, nullptr, up_offset_.data());
}

void GraphProblem::add(ceres::CostFunction* cost, ScalingLoss* loss,
                       std::vector<double*> parameters, bool is_doubted) {
  if (loss == nullptr) {
    problem_.AddResidualBlock(cost, nullptr, parameters);
  } else {
    doubtful_.push_back({cost, loss, std::move(parameters), is_doubted});
  }
}

/// What no measurement tells is held: the first pose, or up in ENU.
void GraphProblem::hold_gauge() {
  if (graph_.is_georeferenced) {
    if (!graph_.levels.empty()) problem_.SetParameterBlockConstant(up_map_.data());
    return;
  }
  PoseBlocks& first = poses_.front();
  add(first);
  problem_.SetParameterBlockConstant(first.rotation());
  problem_.SetParameterBlockConstant(first.translation());
}

}  // namespace traverse::pose_graph
