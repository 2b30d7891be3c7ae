#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sections/sections.hpp"

namespace traverse::report {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// The section alone, with a template that shows what it was given.
std::string rendered_factors(const RunData& run) {
  Model model;
  add_factors(run, model);
  return model.page.fill(
      "{{jacobians_kind}} {{jacobians_text}} "
      "{{jacobians_how}} {{jacobians_formulas}}\n"
      "{{#table_jacobians}}{{#rows}}{{#cells}}{{{text}}};{{/cells}}\n{{/rows}}{{/table_jacobians}}"
      "{{{bench_how}}}\n"
      "{{#table_derivative_evaluations}}{{#rows}}{{#cells}}{{{text}}};{{/cells}}\n{{/rows}}"
      "{{/table_derivative_evaluations}}"
      "{{#table_derivative_solves}}{{#rows}}{{#cells}}{{{text}}};{{/cells}}\n{{/rows}}{{/"
      "table_derivative_solves}}");
}

optimization::JacobianAudit made_audit(bool passed) {
  optimization::FactorAudit factor;
  factor.factor = "line vector";
  factor.formula = "r = u x (q - c)";
  factor.min_residual = 0.5;
  factor.blocks = {{"rotation", 27, {1e-14, 1e-15, 3}, {1e-10, 2e-11, 4}, passed}};
  factor.passed = passed;
  return {{}, {factor}};
}

TEST(FactorsSection, ShowsTheDifferencesAndWhetherTheyPass) {
  RunData run;
  run.jacobians = made_audit(true);
  EXPECT_THAT(rendered_factors(run),
              AllOf(HasSubstr("good every analytic Jacobian is within 1e-09 of"),
                    HasSubstr("200 random"), HasSubstr("line vector: r = u x (q - c)"),
                    HasSubstr("at least 0.500 from zero residual"),
                    HasSubstr("line vector;right;rotation;27.0;1.00e-14;1.00e-15;"
                              "1.00e-10;2.00e-11;pass;")));
  run.jacobians = made_audit(false);
  EXPECT_THAT(rendered_factors(run), AllOf(HasSubstr("fail a Jacobian is wrong"),
                                           HasSubstr("FAIL;"), Not(HasSubstr("every analytic"))));
}

TEST(FactorsSection, ComparesTheDerivativesOfEachCase) {
  using optimization::Derivative;
  RunData run;
  loam::FactorBench bench;
  bench.recording = "a street";
  bench.frame = 10;
  bench.repeats = 51;
  const std::vector<std::string> both{"line vector", "plane signed"};
  for (const auto& [derivative, factor] :
       {std::pair{Derivative::kAnalytic, 1.0}, std::pair{Derivative::kAutomatic, 8.0},
        std::pair{Derivative::kNumeric, 16.0}}) {
    bench.evaluations.push_back(
        {"line vector", derivative, 90, {factor * 50, factor * 49, factor * 53}});
    bench.solves.push_back({both, derivative, 4, {factor, factor, factor}, factor * 1e-9, 0});
  }
  run.factor_bench = bench;
  EXPECT_THAT(
      rendered_factors(run),
      AllOf(HasSubstr("a street, frame 10"),
            HasSubstr("line vector;50.0 ± 2.0;400.0 ± 16.0;800.0 ± 32.0;8.00;16.0;"),
            HasSubstr("line vector + plane signed;1.00 ± 0.00;8.00 ± 0.00;16.0 ± 0.0;8.00;16.0;"
                      "4/4/4;1.60e-08;0;")));
}

TEST(FactorsSection, IsNotThereWithoutFactors) {
  RunData run;
  EXPECT_FALSE(has_factors(run));
  run.jacobians = made_audit(true);
  EXPECT_TRUE(has_factors(run));
}

}  // namespace
}  // namespace traverse::report
