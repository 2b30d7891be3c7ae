#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sections/sections.hpp"

namespace traverse::report {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string rendered_loops(const RunData& run) {
  Model model;
  add_loops(run, model);
  return model.page.fill(
      "{{loops_how}}\n"
      "{{#table_loop_outcomes}}{{#rows}}{{#cells}}{{{text}}};{{/cells}}\n{{/rows}}"
      "{{/table_loop_outcomes}}"
      "{{#table_loop_residuals}}{{#rows}}{{#cells}}{{{text}}};{{/cells}}\n{{/rows}}"
      "{{/table_loop_residuals}}");
}

slam::Loop made_loop(slam::LoopVerdict verdict, double overlap, double graph_chi2) {
  slam::Loop loop;
  loop.verdict = verdict;
  loop.overlap = overlap;
  loop.graph_chi2 = graph_chi2;
  loop.weight = graph_chi2 > 20 ? 0.3 : 1;
  return loop;
}

TEST(LoopsSection, CountsWhatBecameOfTheCandidates) {
  RunData run;
  run.odometry_evaluation.emplace();
  run.loops = {made_loop(slam::LoopVerdict::kAccepted, 0.7, 6),
               made_loop(slam::LoopVerdict::kAccepted, 0.8, 30),
               made_loop(slam::LoopVerdict::kLittleOverlap, 0.2, 0)};
  EXPECT_THAT(rendered_loops(run),
              AllOf(HasSubstr("2 of 3 candidates were accepted"), HasSubstr("accepted;2;0;0.750;"),
                    HasSubstr("little overlap;1;0;0.200;"), HasSubstr("2;3.00;5.00;1;")));
}

TEST(LoopsSection, SaysThatNothingWasClosed) {
  RunData run;
  run.odometry_evaluation.emplace();
  run.loops = {made_loop(slam::LoopVerdict::kOdometry, 0, 0)};
  EXPECT_THAT(rendered_loops(run), HasSubstr("None of 1 candidates was accepted"));
}

TEST(LoopsSection, IsNotThereForOdometryAlone) {
  RunData run;
  EXPECT_FALSE(closes_loops(run));
  run.loops.emplace();
  EXPECT_FALSE(closes_loops(run)) << "as a run folder of localize has them";
  run.odometry_evaluation.emplace();
  EXPECT_TRUE(closes_loops(run));
}

}  // namespace
}  // namespace traverse::report
