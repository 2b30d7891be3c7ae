#include "traverse/lidar/registration.hpp"

#include <cmath>
#include <deque>

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include "point_factor.hpp"
#include "rotation_manifold.hpp"

namespace traverse::lidar {

namespace {

/// The pose as Ceres' parameter blocks.
struct PoseBlocks {
  explicit PoseBlocks(const geometry::Pose3& pose) : q(pose.quaternion()), t(pose.translation) {}
  geometry::Pose3 pose() const { return geometry::Pose3::from_quaternion(q, t); }

  Eigen::Quaterniond q;
  Eigen::Vector3d t;
};

ceres::Problem::Options problem_options() {
  ceres::Problem::Options options;  // everything in the problem lives on the caller's stack
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;  // each block is added once, by us
  return options;
}

/// Factors stay where they are made (a deque), since Ceres keeps their addresses.
template <typename Factor, typename Residual, typename MatchList, typename Shape>
std::deque<Factor> make_factors(const MatchList& matches, const Shape& shape) {
  std::deque<Factor> factors;
  for (const auto& match : matches) factors.emplace_back(match.p_lidar, Residual{shape(match)});
  return factors;
}

template <typename Factor>
void add_factors(ceres::Problem& problem, std::deque<Factor>& factors, ceres::LossFunction& loss,
                 PoseBlocks& blocks) {
  for (Factor& factor : factors) {
    problem.AddResidualBlock(&factor, &loss, blocks.q.coeffs().data(), blocks.t.data());
  }
}

double residual_of(const LineMatch& match, const geometry::Pose3& T) {
  return line_distance_residual(match.line, T * match.p_lidar);
}
double residual_of(const PlaneMatch& match, const geometry::Pose3& T) {
  return plane_residual(match.plane, T * match.p_lidar);
}

void summarise_residuals(const Matches& matches, const SolverOptions& options,
                         SolveResult& result) {
  double sum_of_squares = 0;
  std::size_t inliers = 0;
  const auto count = [&](const auto& match) {
    const double r = residual_of(match, result.T_map_lidar);
    sum_of_squares += r * r;
    if (std::abs(r) <= options.huber_m) ++inliers;
  };
  for (const auto& match : matches.lines) count(match);
  for (const auto& match : matches.planes) count(match);
  const auto n = static_cast<double>(matches.size());
  result.residual_rms_m = std::sqrt(sum_of_squares / n);
  result.inlier_share = static_cast<double>(inliers) / n;
}

}  // namespace

void bind(config::Binder& b, SolverOptions& o) {
  using config::Range;
  static constexpr std::array<std::pair<std::string_view, LineForm>, 2> kLineForms{
      {{"vector", LineForm::kVector}, {"scalar", LineForm::kDistance}}};
  b.choice("line_residual", o.line_form, kLineForms,
           "vector u x (q - c), rank 2, or scalar |u x (q - c)|, rank 1");
  b.integer("iterations", o.iterations, Range::between(1, 1000),
            "Levenberg-Marquardt steps in one solve");
  b.number("huber_m", o.huber_m, Range::positive(), "residuals beyond count linearly");
  b.integer("least_matches", o.least_matches, Range::between(6, 1e6),
            "with fewer matches the prediction stands");
  b.number("least_eigenvalue", o.least_eigenvalue, Range::between(0, 1),
           "directions below are degenerate and keep their prediction");
}

SolveResult solve_pose(const Matches& matches, const geometry::Pose3& guess_T_map_lidar,
                       const SolverOptions& options) {
  SolveResult result;
  result.T_map_lidar = guess_T_map_lidar;
  if (matches.size() < static_cast<std::size_t>(options.least_matches)) {
    result.observability.degenerate = 6;
    return result;
  }

  PoseBlocks blocks(guess_T_map_lidar);
  RotationManifold manifold;
  ceres::HuberLoss loss(options.huber_m);
  const auto line_of = [](const LineMatch& match) { return match.line; };
  const auto plane_of = [](const PlaneMatch& match) { return match.plane; };
  std::deque<PointFactor<LineVectorResidual>> line_vectors;
  std::deque<PointFactor<LineDistanceResidual>> line_distances;
  if (options.line_form == LineForm::kVector) {
    line_vectors =
        make_factors<PointFactor<LineVectorResidual>, LineVectorResidual>(matches.lines, line_of);
  } else {
    line_distances = make_factors<PointFactor<LineDistanceResidual>, LineDistanceResidual>(
        matches.lines, line_of);
  }
  auto planes = make_factors<PointFactor<PlaneResidual>, PlaneResidual>(matches.planes, plane_of);

  ceres::Problem problem(problem_options());
  problem.AddParameterBlock(blocks.q.coeffs().data(), 4, &manifold);
  problem.AddParameterBlock(blocks.t.data(), 3);
  add_factors(problem, line_vectors, loss, blocks);
  add_factors(problem, line_distances, loss, blocks);
  add_factors(problem, planes, loss, blocks);

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = options.iterations;
  solver.num_threads = 1;  // a fixed order of summation: the same bits on every machine load
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  result.iterations = static_cast<int>(summary.iterations.size()) - 1;
  if (!summary.IsSolutionUsable()) return result;

  const geometry::Pose3 solved = blocks.pose();
  result.observability = observability(matches, solved, options.least_eigenvalue);
  if (result.observability.degenerate == 0) {
    result.T_map_lidar = solved;
  } else {
    const geometry::Twist step = geometry::log_se3(guess_T_map_lidar.inverse() * solved);
    result.T_map_lidar =
        guess_T_map_lidar * geometry::exp_se3(result.observability.well_observed(step));
  }
  result.usable = true;
  summarise_residuals(matches, options, result);
  return result;
}

}  // namespace traverse::lidar
