#include "traverse/voxel_map/alignment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <ceres/problem.h>
#include <ceres/solver.h>

#include "traverse/geometry/so3.hpp"
#include "traverse/lidar/stopwatch.hpp"
#include "traverse/optimization/rotation_manifold.hpp"
#include "traverse/optimization/solution.hpp"
#include "traverse/optimization/termination.hpp"
#include "traverse/parallel/workers.hpp"
#include "traverse/voxel_map/scan_information.hpp"

#include "condensed_cost.hpp"

namespace traverse::voxel_map {

using optimization::Termination;

namespace {

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

namespace {

constexpr int kPolishingRounds = 2;  // after a degenerate direction was given its prediction back

/// The registration of one scan, round by round.
class Registration {
 public:
  Registration(const SweepSample& sample, const VoxelMap& map, const MotionModel& motion,
               const AlignmentOptions& options, parallel::Workers& workers, ScanMatches& matches,
               lidar::StageTimes& ms)
      : sample_(sample),
        map_(map),
        motion_(motion),
        options_(options),
        workers_(workers),
        matches_(matches),
        ms_(ms),
        scale_m_(usual_range_m(sample)) {
    matches_.forget();
  }

  Alignment from(const geometry::Pose3& guess, const Effort& effort) {
    result_.T_map_lidar = guess;
    const bool moved = approach(guess, options_.rounds + effort.extra_rounds, effort.gate_factor);
    lidar::RegistrationHealth& health = result_.health;
    if (!moved) return result_;
    judge_directions();
    if (health.observability.degenerate == 0) return result_;
    // Along such a direction the matches' noise has moved the pose, not what they measure.
    const geometry::Twist step = geometry::log_se3(guess.inverse() * result_.T_map_lidar);
    result_.T_map_lidar = guess * geometry::exp_se3(health.observability.well_observed(step));
    polish(guess);
    return result_;
  }

 private:
  /// Rounds until a step is small. \returns whether the scan was registered
  bool approach(const geometry::Pose3& guess, int rounds, double gate_factor) {
    result_.health.end(Termination::kIterationLimit);
    for (int round = 0; round < rounds; ++round) {
      const double halved = gate_factor * options_.gate_m * std::pow(0.5, std::max(0, round - 1));
      const auto step = step_once(guess, std::max(halved, options_.narrow_gate_m));
      if (!step) return false;
      result_.T_map_lidar = result_.T_map_lidar * geometry::exp_se3(*step);
      if (round >= 1 && is_small(*step)) {
        result_.health.end(Termination::kConverged);
        break;
      }
    }
    return true;
  }

  /// The directions that are judged keep their prediction; the others adapt to it.
  void polish(const geometry::Pose3& guess) {
    const lidar::Observability judged = result_.health.observability;
    result_.health.end(Termination::kIterationLimit);
    for (int round = 0; round < kPolishingRounds; ++round) {
      const geometry::Pose3 before = result_.T_map_lidar;
      const auto step = step_once(guess, options_.narrow_gate_m);
      if (!step) return;
      const geometry::Twist kept = judged.well_observed(*step);
      result_.T_map_lidar = before * geometry::exp_se3(kept);
      if (is_small(kept)) {
        result_.health.end(Termination::kConverged);
        break;
      }
    }
    result_.health.observability = judged;
  }

  /// Associates at the present pose and solves once. \returns the step (body twist); nothing, and
  /// the guess as the pose, where there are too few matches or no solution
  std::optional<geometry::Twist> step_once(const geometry::Pose3& guess, double gate_m) {
    associate_at(sample_, result_.T_map_lidar, motion_, map_, gate_m, options_.matches, workers_,
                 moved_, matches_, ms_);
    lidar::Stopwatch watch;
    lidar::RegistrationHealth& health = result_.health;

    ++health.steps;
    health.line_matches = matches_.line_1.size();
    health.plane_matches = matches_.planes.size();
    result_.standing_planes = matches_.standing_planes;
    if (matches_.size() < static_cast<std::size_t>(options_.min_matches)) {
      return give_up(guess, Termination::kTooFewMatches);
    }
    CondensedCost cost(matches_, motion_, options_.objective, workers_);
    normal_ = cost.at(result_.T_map_lidar);
    T_map_lidar_of_normal_ = result_.T_map_lidar;
    const auto count = static_cast<double>(matches_.size());
    health.residual_rms_m = std::sqrt(normal_.squared_m / count);
    health.inlier_share = normal_.inliers / count;
    const Solved solved = solve(cost, result_.T_map_lidar, options_.iterations);
    health.iterations += solved.iterations;
    watch.lap(ms_.solve);
    if (!solved.usable) return give_up(guess, Termination::kNotSolvable);
    health.registered = true;
    return geometry::log_se3(result_.T_map_lidar.inverse() * solved.T_map_lidar);
  }

  std::optional<geometry::Twist> give_up(const geometry::Pose3& guess, Termination why) {
    result_.health.end(why);
    result_.health.registered = false;
    result_.health.observability.degenerate = 6;
    result_.T_map_lidar = guess;
    return std::nullopt;
  }

  bool is_small(const geometry::Twist& step) const {
    return step.tail<3>().norm() < options_.converged_m &&
           step.head<3>().norm() * 180 / std::numbers::pi < options_.converged_deg;
  }

  void judge_directions() {
    lidar::Stopwatch watch;
    result_.health.observability = judged_observability(normal_, matches_, T_map_lidar_of_normal_,
                                                        motion_, scale_m_, options_.min_eigenvalue);
    watch.lap(ms_.solve);
  }

  const SweepSample& sample_;
  const VoxelMap& map_;
  const MotionModel& motion_;
  const AlignmentOptions& options_;
  parallel::Workers& workers_;
  ScanMatches& matches_;
  lidar::StageTimes& ms_;
  double scale_m_;
  MovedSample moved_;
  NormalEquations normal_;
  geometry::Pose3 T_map_lidar_of_normal_;
  Alignment result_;
};

}  // namespace

Alignment align(const SweepSample& sample, const VoxelMap& map, const MotionModel& motion,
                const geometry::Pose3& guess_T_map_lidar, const AlignmentOptions& options,
                const Effort& effort, parallel::Workers& workers, ScanMatches& matches,
                lidar::StageTimes& ms) {
  Registration registration(sample, map, motion, options, workers, matches, ms);
  return registration.from(guess_T_map_lidar, effort);
}

}  // namespace traverse::voxel_map
