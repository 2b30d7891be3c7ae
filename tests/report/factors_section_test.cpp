#include <set>
#include <string>
#include <vector>

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

/// Three frames of a navigation run that turns and gathers speed; the last began anew.
RunData made_navigation() {
  RunData run;
  run.jacobians = made_audit(true);
  std::vector<std::string> columns{"frame", "stamp_s", "restarted"};
  for (const std::string axis : {"x", "y", "z"}) {
    columns.push_back("gyro_bias_" + axis + "_rad_s");
    columns.push_back("accelerometer_bias_" + axis + "_m_s2");
  }
  for (const std::string direction : {"east", "north", "up"}) {
    columns.push_back("velocity_" + direction + "_mps");
  }
  run.frames = pipeline::FrameTable(columns);
  for (const double k : {0.0, 1.0, 2.0}) {
    run.frames.add_row(
        {7 + k, 0.2 * k, k == 2 ? 1.0 : 0.0, 0.01, 0.1, -0.02, 0.2, 0.03, 0, 4 + k, 3, 0.1});
    geometry::Pose3 pose;
    pose.rotation = Eigen::AngleAxisd(0.1 * k, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    pose.translation = {0.9 * k, 0.6 * k, 0};
    run.estimate.push_back(geometry::Stamp::from_seconds(0.2 * k), pose);
  }
  return run;
}

TEST(FactorsSection, ShowsTheInertialFactorAtAStateOfTheRun) {
  Model model;
  add_factors(made_navigation(), model);
  const Json& table = model.json["tables"]["inertial_jacobians"];
  ASSERT_EQ(table["rows"].size(), 14U * 3);
  std::set<std::string> blocks;
  for (const Json& row : table["rows"]) {
    blocks.insert(row[0].get<std::string>());
    for (std::size_t k = 2; k < 5; ++k) {
      EXPECT_NEAR(row[k].get<double>(), row[k + 3].get<double>(), 1e-5) << row.dump();
    }
    EXPECT_LT(row[8].get<double>(), 1e-7) << row.dump();
  }
  EXPECT_THAT(blocks, ::testing::UnorderedElementsAre(
                          "dR/dR1", "dR/dbg1", "dR/dR2", "dv/dR1", "dv/dv1", "dv/dbg1", "dv/dba1",
                          "dv/dv2", "dp/dR1", "dp/dp1", "dp/dv1", "dp/dbg1", "dp/dba1", "dp/dp2"));
  EXPECT_THAT(model.text("inertial_jacobians_title"),
              AllOf(HasSubstr("The 14 blocks"), HasSubstr("frame 8")));
}

TEST(FactorsSection, ShowsNoInertialFactorWhereNoStateIsToldOrNoneFollowsAnother) {
  RunData run;
  run.jacobians = made_audit(true);
  Model without;
  add_factors(run, without);
  EXPECT_FALSE(without.json["tables"].contains("inertial_jacobians"));

  run = made_navigation();
  run.frames = pipeline::FrameTable(run.frames.columns());
  run.estimate = {};
  Model empty;
  add_factors(run, empty);
  EXPECT_FALSE(empty.json["tables"].contains("inertial_jacobians"));
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
