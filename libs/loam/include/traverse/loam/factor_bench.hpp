#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "traverse/loam/frame_correspondences.hpp"
#include "traverse/loam/registration.hpp"

namespace traverse::files {
class JsonValue;
}

namespace traverse::loam {

/// Median of the repeats of a measurement and the values below which a quarter and three quarters
/// of them lie.
struct Spread {
  double median = 0;
  double lower_quartile = 0;
  double upper_quartile = 0;
};

/// What it takes to evaluate a residual with its Jacobians once.
struct EvaluationCost {
  std::string factor;  ///< name of its kind, factor_kinds()
  optimization::Derivative derivative = optimization::Derivative::kAnalytic;
  std::size_t residuals = 0;  ///< evaluated in each repeat, one a match
  Spread nanoseconds;         ///< of one
};

/// What it takes to solve for the pose, from matches to solution.
struct SolveCost {
  std::vector<std::string> factors;  ///< of lines and of planes
  optimization::Derivative derivative = optimization::Derivative::kAnalytic;
  int iterations = 0;
  Spread milliseconds;
  double from_analytic_m = 0;    ///< distance of the pose found from that by analytic derivatives
  double from_analytic_rad = 0;  ///< angle
};

struct FactorBench {
  std::string recording;   ///< whose frame it was, for people
  std::size_t frame = 0;   ///< counted from 0 in the recording
  std::size_t lines = 0;   ///< matches
  std::size_t planes = 0;  ///< matches
  int repeats = 0;
  std::vector<EvaluationCost> evaluations;
  std::vector<SolveCost> solves;
};

/// Measures analytic, automatic and numeric derivatives on the same correspondences, in processor
/// time of this thread.
/// In each repeat every derivative has its turn, so that what disturbs the machine disturbs all.
/// \param solver loss, iterations and thresholds of the solves; its forms and derivative are varied
FactorBench measure_factors(const FrameCorrespondences& frame, const SolverOptions& solver,
                            int repeats);

/// The measurement as JSON: {"recording", "frame", "lines", "planes", "repeats", "evaluations":
/// [{"factor", "derivative", "residuals", "nanoseconds": S}], "solves": [{"factors", "derivative",
/// "iterations", "milliseconds": S, "from_analytic_m", "from_analytic_rad"}]} with
/// S = {"median", "lower_quartile", "upper_quartile"}; sealed (files::sealed_json).
std::string to_json(const FactorBench& bench);

/// Reads what to_json() wrote. \throws files::InputError naming the file and the key.
FactorBench factor_bench_from_json(const files::JsonValue& json);

}  // namespace traverse::loam
