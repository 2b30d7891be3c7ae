#include "traverse/loam/registration.hpp"

#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include "traverse/optimization/rotation_manifold.hpp"
#include "traverse/optimization/solution.hpp"

#include "match_observability.hpp"
#include "point_motion.hpp"
#include "pose_factors.hpp"

namespace traverse::loam {

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

double residual_of(const LineMatch& match, const geometry::Pose3& T) {
  return line_distance_residual(match.line, part_of(T, match.fraction) * match.p_lidar);
}
double residual_of(const PlaneMatch& match, const geometry::Pose3& T) {
  return plane_residual(match.plane, part_of(T, match.fraction) * match.p_lidar);
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
  static constexpr std::array<std::pair<std::string_view, PlaneForm>, 2> kPlaneForms{
      {{"signed", PlaneForm::kSigned}, {"absolute", PlaneForm::kAbsolute}}};
  b.choice("plane_residual", o.plane_form, kPlaneForms, "n . q + d, or its absolute value");
  b.choice("derivative", o.derivative, optimization::kDerivativeNames,
           "formulas, dual numbers, or central differences");
  b.choice("perturbation", o.perturbation, optimization::kPerturbationNames,
           "side of the rotation's perturbation: R Exp(d), or Exp(d) R");
  b.integer("iterations", o.iterations, Range::between(1, 1000),
            "Levenberg-Marquardt steps in one solve");
  b.number("huber_m", o.huber_m, Range::positive(),
           "Huber threshold: larger residuals count linearly");
  b.integer("min_matches", o.min_matches, Range::between(6, 1e6),
            "with fewer matches the prediction is kept");
  b.number("min_eigenvalue", o.min_eigenvalue, Range::between(0, 1),
           "directions with a smaller eigenvalue are degenerate and keep the prediction");
}

SolveResult solve_pose(const Matches& matches, const geometry::Pose3& guess_T_map_lidar,
                       const SolverOptions& options) {
  SolveResult result;
  result.T_map_lidar = guess_T_map_lidar;
  if (matches.size() < static_cast<std::size_t>(options.min_matches)) {
    result.observability.degenerate = 6;
    result.reason = optimization::Termination::kTooFewMatches;
    return result;
  }

  PoseBlocks blocks(guess_T_map_lidar);
  optimization::RotationManifold manifold(options.perturbation);
  ceres::HuberLoss loss(options.huber_m);
  const PoseFactors factors(matches, options);
  ceres::Problem problem(problem_options());
  problem.AddParameterBlock(blocks.q.coeffs().data(), 4, &manifold);
  problem.AddParameterBlock(blocks.t.data(), 3);
  for (ceres::CostFunction* factor : factors.cost_functions()) {
    problem.AddResidualBlock(factor, &loss, blocks.q.coeffs().data(), blocks.t.data());
  }

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = options.iterations;
  solver.num_threads = 1;  // a fixed order of summation: the same bits on every machine load
  solver.logging_type = ceres::SILENT;
  const optimization::Solution solution = optimization::solve(solver, problem);
  result.iterations = solution.iterations;
  result.reason = solution.reason;
  if (!solution.is_usable) return result;

  const geometry::Pose3 solved = blocks.pose();
  result.observability = observability(matches, solved, options.min_eigenvalue);
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

}  // namespace traverse::loam
