#include "traverse/loam/factor_bench.hpp"

#include <algorithm>
#include <array>
#include <ctime>

#include "traverse/geometry/so3.hpp"
#include "traverse/loam/factor_kinds.hpp"
#include "traverse/statistics/quantile.hpp"

#include "pose_factors.hpp"

namespace traverse::loam {

namespace {

using optimization::Derivative;

constexpr std::array kDerivatives{Derivative::kAnalytic, Derivative::kAutomatic,
                                  Derivative::kNumeric};

/// Seconds that this thread has been working, without those in which the machine did other things.
double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

template <typename Work>
double seconds_of(const Work& work) {
  const double begin = thread_seconds();
  work();
  return thread_seconds() - begin;
}

Spread spread_of(const std::vector<double>& values) {
  return {statistics::median(values), statistics::quantile(values, 0.25),
          statistics::quantile(values, 0.75)};
}

/// Evaluates each cost function once with all Jacobians.
void evaluate_all(const PoseFactors& factors, const geometry::Pose3& pose) {
  const Eigen::Quaterniond q = pose.quaternion();
  const std::array<const double*, 2> parameters{q.coeffs().data(), pose.translation.data()};
  std::array<double, 3> residual{};
  std::array<double, 3 * 4> by_rotation{};
  std::array<double, 3 * 3> by_translation{};
  std::array<double*, 2> jacobians{by_rotation.data(), by_translation.data()};
  for (const ceres::CostFunction* factor : factors.cost_functions()) {
    factor->Evaluate(parameters.data(), residual.data(), jacobians.data());
  }
}

/// One kind of factor: the matches of that kind and the options that choose its form.
struct EvaluationCase {
  std::string factor;
  Matches matches;
  SolverOptions options;
};

std::vector<EvaluationCase> evaluation_cases(const Matches& matches, Sweep sweep) {
  std::vector<EvaluationCase> cases;
  for (const LineForm form : {LineForm::kVector, LineForm::kDistance}) {
    SolverOptions options;
    options.line_form = form;
    cases.push_back({factors_of(options, sweep)[0].factor, {matches.lines, {}}, options});
  }
  for (const PlaneForm form : {PlaneForm::kSigned, PlaneForm::kAbsolute}) {
    SolverOptions options;
    options.plane_form = form;
    cases.push_back({factors_of(options, sweep)[1].factor, {{}, matches.planes}, options});
  }
  return cases;
}

void measure_evaluations(const Matches& matches, const geometry::Pose3& pose, Sweep sweep,
                         FactorBench& bench) {
  for (EvaluationCase& each : evaluation_cases(matches, sweep)) {
    if (each.matches.size() == 0) continue;
    std::vector<PoseFactors> factors;
    for (const Derivative derivative : kDerivatives) {
      each.options.derivative = derivative;
      factors.emplace_back(each.matches, each.options);
    }
    const auto count = static_cast<double>(each.matches.size());
    std::array<std::vector<double>, kDerivatives.size()> nanoseconds;
    for (int repeat = 0; repeat < bench.repeats; ++repeat) {
      for (std::size_t d = 0; d < kDerivatives.size(); ++d) {
        const double seconds = seconds_of([&] { evaluate_all(factors[d], pose); });
        nanoseconds[d].push_back(1e9 * seconds / count);
      }
    }
    for (std::size_t d = 0; d < kDerivatives.size(); ++d) {
      bench.evaluations.push_back(
          {each.factor, kDerivatives[d], each.matches.size(), spread_of(nanoseconds[d])});
    }
  }
}

void measure_solves(const Matches& matches, const geometry::Pose3& guess, Sweep sweep,
                    SolverOptions options, FactorBench& bench) {
  for (const LineForm form : {LineForm::kVector, LineForm::kDistance}) {
    options.line_form = form;
    options.plane_form = PlaneForm::kSigned;
    std::array<SolveResult, kDerivatives.size()> results;
    std::array<std::vector<double>, kDerivatives.size()> milliseconds;
    for (int repeat = 0; repeat < bench.repeats; ++repeat) {
      for (std::size_t d = 0; d < kDerivatives.size(); ++d) {
        options.derivative = kDerivatives[d];
        const double seconds =
            seconds_of([&] { results[d] = solve_pose(matches, guess, options); });
        milliseconds[d].push_back(1e3 * seconds);
      }
    }
    std::vector<std::string> factors;
    for (const auto& use : factors_of(options, sweep)) factors.push_back(use.factor);
    for (std::size_t d = 0; d < kDerivatives.size(); ++d) {
      const geometry::Pose3 difference = results[0].T_map_lidar.inverse() * results[d].T_map_lidar;
      bench.solves.push_back({factors, kDerivatives[d], results[d].iterations,
                              spread_of(milliseconds[d]), difference.translation.norm(),
                              geometry::angle_of(difference.rotation)});
    }
  }
}

}  // namespace

FactorBench measure_factors(const FrameCorrespondences& frame, const SolverOptions& solver,
                            int repeats) {
  FactorBench bench;
  bench.lines = frame.matches.lines.size();
  bench.planes = frame.matches.planes.size();
  bench.repeats = std::max(1, repeats);
  measure_evaluations(frame.matches, frame.guess_T_map_lidar, Sweep::kDeskewed, bench);
  measure_evaluations(frame.swept, frame.guess_T_begin_end, Sweep::kSwept, bench);
  const auto enough = static_cast<std::size_t>(solver.min_matches);
  if (frame.matches.size() >= enough) {
    measure_solves(frame.matches, frame.guess_T_map_lidar, Sweep::kDeskewed, solver, bench);
  }
  if (frame.swept.size() >= enough) {
    measure_solves(frame.swept, frame.guess_T_begin_end, Sweep::kSwept, solver, bench);
  }
  return bench;
}

}  // namespace traverse::loam
