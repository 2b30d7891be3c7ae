#include <algorithm>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "run/number_texts.hpp"
#include "sections/inertial_jacobians.hpp"
#include "sections/sections.hpp"

namespace traverse::report {

namespace {

using loam::FactorBench;
using loam::Spread;
using optimization::JacobianAudit;

Table jacobians_table(const JacobianAudit& audit) {
  Table table("jacobians", "Jacobians of the factors of this run",
              {"factor", "perturbation", "block", "largest entry", "to automatic: absolute",
               "relative", "to differences: absolute", "relative", "verdict"});
  for (const optimization::FactorAudit& factor : audit.factors) {
    for (const optimization::BlockAudit& block : factor.blocks) {
      table.add_row(
          {factor.factor, std::string(name_of(factor.perturbation)), block.block,
           block.largest_entry, block.automatic.absolute, block.automatic.relative,
           block.numeric.absolute, block.numeric.relative, block.passed ? "pass" : "FAIL"},
          !block.passed);
    }
  }
  return table;
}

/// "line vector: r = u × (q − c), q = R p + t; plane signed: ..."
std::string formulas_text(const JacobianAudit& audit) {
  std::vector<std::string> formulas;
  for (const optimization::FactorAudit& factor : audit.factors) {
    formulas.push_back(factor.factor + ": " + factor.formula);
  }
  return fmt::format("{}", fmt::join(formulas, "; "));
}

void add_jacobians(const JacobianAudit& audit, Model& model) {
  const auto& options = audit.options;
  model.add_table(jacobians_table(audit));
  model.add_text("jacobians_formulas", formulas_text(audit));
  model.page.set("jacobians_kind", audit.passed() ? "good" : "fail");
  model.page.set("jacobians_word", audit.passed() ? "Pass:" : "Fail:");
  model.add_text(
      "jacobians_text",
      audit.passed()
          ? fmt::format(
                "every analytic Jacobian is within {:.0e} of automatic derivatives and {:.0e} "
                "of differences.",
                options.automatic_tolerance, options.numeric_tolerance)
          : std::string("a Jacobian is wrong (marked): the solver does not find the minimum "
                        "of what it says it minimises."));
  model.add_text(
      "jacobians_how",
      fmt::format("Analytic Jacobians against dual numbers and against central differences "
                  "of the factor's own value, computed by the program that made this run: {} "
                  "random states, at least {} from zero residual (seed {}). The largest "
                  "differences of all; relative to the largest entry of the block.",
                  count_text(options.states),
                  short_number(std::min_element(audit.factors.begin(), audit.factors.end(),
                                                [](const auto& a, const auto& b) {
                                                  return a.min_residual < b.min_residual;
                                                })
                                   ->min_residual),
                  options.seed));
}

/// The costs of one case: analytic, automatic, numeric.
template <typename Cost>
std::vector<std::span<const Cost>> by_case(const std::vector<Cost>& costs) {
  constexpr std::size_t kEach = optimization::kDerivativeNames.size();
  std::vector<std::span<const Cost>> cases;
  for (std::size_t i = 0; i + kEach <= costs.size(); i += kEach) {
    cases.emplace_back(costs.data() + i, kEach);
  }
  return cases;
}

/// The median and half of what lies between the quartiles, with the decimals of the median.
Cell spread_cell(const Spread& spread) {
  Cell cell(spread.median);
  const std::size_t point = cell.text.find('.');
  const std::size_t decimals = point == std::string::npos ? 0 : cell.text.size() - point - 1;
  cell.text +=
      fmt::format(" ± {:.{}f}", (spread.upper_quartile - spread.lower_quartile) / 2, decimals);
  return cell;
}

Table evaluations_table(const FactorBench& bench) {
  Table table(
      "derivative_evaluations", "A residual with its Jacobians, nanoseconds",
      {"factor", "analytic", "automatic", "numeric", "automatic / analytic", "numeric / analytic"});
  for (const auto& costs : by_case(bench.evaluations)) {
    const double analytic = costs[0].nanoseconds.median;
    table.add_row({costs[0].factor, spread_cell(costs[0].nanoseconds),
                   spread_cell(costs[1].nanoseconds), spread_cell(costs[2].nanoseconds),
                   costs[1].nanoseconds.median / analytic, costs[2].nanoseconds.median / analytic});
  }
  return table;
}

Table solves_table(const FactorBench& bench) {
  Table table("derivative_solves", "A whole solve for the pose, milliseconds",
              {"factors", "analytic", "automatic", "numeric", "automatic / analytic",
               "numeric / analytic", "steps", "poses apart [m]", "[deg]"});
  for (const auto& costs : by_case(bench.solves)) {
    const double analytic = costs[0].milliseconds.median;
    const double radians = std::max(costs[1].from_analytic_rad, costs[2].from_analytic_rad);
    table.add_row(
        {fmt::format("{}", fmt::join(costs[0].factors, " + ")), spread_cell(costs[0].milliseconds),
         spread_cell(costs[1].milliseconds), spread_cell(costs[2].milliseconds),
         costs[1].milliseconds.median / analytic, costs[2].milliseconds.median / analytic,
         fmt::format("{}/{}/{}", costs[0].iterations, costs[1].iterations, costs[2].iterations),
         std::max(costs[1].from_analytic_m, costs[2].from_analytic_m),
         radians * 180 / std::numbers::pi});
  }
  return table;
}

void add_bench(const FactorBench& bench, Model& model) {
  model.add_table(evaluations_table(bench));
  model.add_table(solves_table(bench));
  model.add_text(
      "bench_text",
      "Analytic, automatic (dual numbers) and numeric (central differences) derivatives on "
      "the same correspondences: what each costs, and how far from the pose by analytic ones "
      "the two others end.");
  model.add_text(
      "bench_how",
      fmt::format(
          "{}, frame {}: {} line and {} plane matches, {} repeats in turn, CPU time of one thread; "
          "medians ± half "
          "of what lies between the quartiles. Swept points have each seen their part "
          "of the sweep's motion.",
          bench.recording, bench.frame, count_text(bench.lines), count_text(bench.planes),
          bench.repeats));
}

}  // namespace

bool has_factors(const RunData& run) { return run.jacobians || run.factor_bench; }

void add_factors(const RunData& run, Model& model) {
  const bool audited = run.jacobians && !run.jacobians->factors.empty();
  model.page.set("has_jacobians", audited);
  model.page.set("has_bench", run.factor_bench.has_value());
  if (audited) add_jacobians(*run.jacobians, model);
  if (audited) add_inertial_jacobians(run, model);
  if (run.factor_bench) add_bench(*run.factor_bench, model);
}

}  // namespace traverse::report
