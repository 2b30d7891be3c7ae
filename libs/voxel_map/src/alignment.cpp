#include "traverse/voxel_map/alignment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <ceres/problem.h>
#include <ceres/solver.h>

#include "traverse/geometry/so3.hpp"
#include "traverse/lidar/stopwatch.hpp"
#include "traverse/optimization/rotation_manifold.hpp"
#include "traverse/optimization/solution.hpp"
#include "traverse/parallel/workers.hpp"
#include "traverse/statistics/quantile.hpp"

#include "condensed_cost.hpp"

namespace traverse::voxel_map {

namespace {

double usual_range(std::vector<float> ranges) {
  return ranges.empty() ? 1 : statistics::element_at_share(ranges, 0.5);
}

/// The information of the matches on the body twist, rotation in units of `scale_m`, a match's
/// mean.
lidar::Matrix6 information(const NormalEquations& normal, const Eigen::Matrix3d& R_map_lidar,
                           double scale_m) {
  lidar::Matrix6 axes = lidar::Matrix6::Identity();
  axes.topLeftCorner<3, 3>() /= scale_m;
  axes.bottomRightCorner<3, 3>() = R_map_lidar;
  return axes.transpose() * normal.H * axes / normal.weight;
}

ceres::Problem::Options problem_options() {
  ceres::Problem::Options options;  // everything in the problem lives on the caller's stack
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;
  return options;
}

struct Solved {
  geometry::Pose3 T_map_lidar;
  int iterations = 0;
  bool usable = false;
};

Solved solve(CondensedCost& cost, const geometry::Pose3& guess, int iterations) {
  Eigen::Quaterniond q = guess.quaternion();
  Eigen::Vector3d t = guess.translation;
  optimization::RotationManifold manifold;
  ceres::Problem problem(problem_options());
  problem.AddParameterBlock(q.coeffs().data(), 4, &manifold);
  problem.AddParameterBlock(t.data(), 3);
  problem.AddResidualBlock(&cost, nullptr, q.coeffs().data(), t.data());

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = iterations;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  const optimization::Solution solution = optimization::solve(options, problem);
  return {geometry::Pose3::from_quaternion(q, t), solution.iterations, solution.is_usable};
}

}  // namespace

void bind(config::Binder& b, AlignmentOptions& o) {
  using config::Range;
  b.integer("rounds", o.rounds, Range::between(1, 100),
            "rounds of association and solution at most");
  b.integer("iterations", o.iterations, Range::between(1, 100),
            "Levenberg-Marquardt steps in a round");
  b.number("gate_m", o.gate_m, Range::positive(), "largest distance of a match");
  b.number("narrow_gate_m", o.narrow_gate_m, Range::positive(),
           "the gate halves each round down to this");
  b.number("converged_m", o.converged_m, Range::non_negative(), "step at convergence");
  b.number("converged_deg", o.converged_deg, Range::non_negative(), "rotation at convergence");
  b.integer("min_matches", o.min_matches, Range::between(6, 1e6),
            "with fewer matches the prediction is kept");
  b.number("min_eigenvalue", o.min_eigenvalue, Range::between(0, 1),
           "directions with a smaller eigenvalue are degenerate and keep the prediction");
  bind(b, o.matches);
  bind(b, o.objective);
}

Alignment align(const SweepSample& sample, const VoxelMap& map, const MotionModel& motion,
                const geometry::Pose3& guess_T_map_lidar, const AlignmentOptions& options,
                const Effort& effort, parallel::Workers& workers, ScanMatches& matches,
                lidar::StageTimes& ms) {
  lidar::Stopwatch watch;
  Alignment result;
  result.T_map_lidar = guess_T_map_lidar;
  lidar::RegistrationHealth& health = result.health;
  const double scale_m = usual_range(sample.planar.range);
  LocalPoints planar;
  LocalPoints edges;
  matches.forget();
  for (int round = 0; round < options.rounds + effort.extra_rounds; ++round) {
    const geometry::Twist velocity = motion.velocity_at(result.T_map_lidar);
    to_local(sample.planar, result.T_map_lidar, velocity, workers, planar);
    to_local(sample.edges, result.T_map_lidar, velocity, workers, edges);
    watch.lap(ms.deskew);
    const double halved =
        effort.gate_factor * options.gate_m * std::pow(0.5, std::max(0, round - 1));
    associate(sample, planar, edges, map, std::max(halved, options.narrow_gate_m), options.matches,
              workers, matches);
    watch.lap(ms.associate);

    ++health.steps;
    health.line_matches = matches.line_1.size();
    health.plane_matches = matches.planes.size();
    result.standing_planes = matches.standing_planes;
    if (matches.size() < static_cast<std::size_t>(options.min_matches)) {
      health.registered = false;
      health.observability.degenerate = 6;
      result.T_map_lidar = guess_T_map_lidar;
      break;
    }
    CondensedCost cost(matches, motion, options.objective, workers);
    const NormalEquations normal = cost.at(result.T_map_lidar);
    const auto count = static_cast<double>(matches.size());
    health.residual_rms_m = std::sqrt(normal.squared_m / count);
    health.inlier_share = normal.inliers / count;
    health.observability = lidar::observability(
        information(normal, result.T_map_lidar.rotation, scale_m), scale_m, options.min_eigenvalue);

    const Solved solved = solve(cost, result.T_map_lidar, options.iterations);
    health.iterations += solved.iterations;
    health.registered = solved.usable;
    if (!solved.usable) {
      result.T_map_lidar = guess_T_map_lidar;
      break;
    }
    geometry::Twist step = geometry::log_se3(result.T_map_lidar.inverse() * solved.T_map_lidar);
    if (health.observability.degenerate == 0) {
      result.T_map_lidar = solved.T_map_lidar;
    } else {
      step = health.observability.well_observed(step);
      result.T_map_lidar = result.T_map_lidar * geometry::exp_se3(step);
    }
    watch.lap(ms.solve);
    const double turned_deg = step.head<3>().norm() * 180 / std::numbers::pi;
    if (round >= 1 && step.tail<3>().norm() < options.converged_m &&
        turned_deg < options.converged_deg) {
      break;
    }
  }
  return result;
}

}  // namespace traverse::voxel_map
