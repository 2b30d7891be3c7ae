#include "results/summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "batch/made_plan.hpp"

namespace traverse::batch {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kApe = "ape_translation_rmse";

/// Two recordings of unequal length; what "quick" cannot do, "steady" can.
Results made_results() {
  Results results({made_job("long", "quick"), made_job("short", "quick"),
                   made_job("long", "steady"), made_job("short", "steady"),
                   made_job("short", "steady", 2)});
  const auto kitti = [](double ape, double percent, double segments) {
    return std::vector<MetricValue>{{kApe, ape},
                                    {"kitti_translation_percent", percent},
                                    {"kitti_rotation_deg_per_m", percent / 100},
                                    {"kitti_segments", segments}};
  };
  const auto& jobs = results.jobs();
  results.add(made_completion(jobs[0], {}, Outcome::kCrashed));
  results.add(made_completion(jobs[1], kitti(0.1, 0.5, 10)));
  results.add(made_completion(jobs[2], kitti(0.4, 2, 90)));
  results.add(made_completion(jobs[3], kitti(0.2, 1, 10)));
  results.add(made_completion(jobs[4], kitti(0.4, 1, 10)));
  return results;
}

TEST(Summary, RanksByRunsThatAreOkAndThenByTheMetric) {
  const auto variants = summarise(made_results(), {}, kApe);
  ASSERT_EQ(variants.size(), 2U);
  EXPECT_EQ(variants[0].variant, "steady");
  EXPECT_EQ(variants[1].ok, 1U);
  EXPECT_EQ(variants[1].runs, 2U);
}

/// The map of a run that does not move is the sharpest.
TEST(Summary, ARunThatIsLostHasNoFigureAndNoRankAndADegradedOneStandsBelowAnOkOne) {
  for (const Outcome outcome : {Outcome::kLost, Outcome::kDegraded}) {
    Results results({made_job("a", "still"), made_job("b", "still"), made_job("a", "moving"),
                     made_job("b", "moving")});
    const auto& jobs = results.jobs();
    results.add(made_completion(jobs[0], {{"mme", -9.17}}, outcome));
    results.add(made_completion(jobs[1], {{"mme", -4.2}}));
    results.add(made_completion(jobs[2], {{"mme", -4.07}}));
    results.add(made_completion(jobs[3], {{"mme", -4.1}}));
    const auto variants = summarise(results, {}, "mme");
    EXPECT_EQ(variants[0].variant, "moving") << name_of(outcome);
    EXPECT_EQ(variants[0].ok, 2U);
    EXPECT_EQ(variants[1].ok, outcome == Outcome::kLost ? 1U : 2U);
    EXPECT_NEAR(variants[1].means.at("mme"), outcome == Outcome::kLost ? -4.2 : (-9.17 - 4.2) / 2,
                1e-12);
  }
}

TEST(Summary, ABudgetOfWhatIsBetterWhenItIsMoreIsTheLeast) {
  const Completion one = made_completion(made_job("a", "p"), {{"registered_share", 0.9}});
  EXPECT_TRUE(broken_budgets(one, {{"registered_share", 0.8}}).empty());
  EXPECT_EQ(broken_budgets(one, {{"registered_share", 0.95}}).size(), 1U);
}

TEST(Summary, AveragesRepeatsBeforeRecordings) {
  const auto variants = summarise(made_results(), {}, kApe);
  EXPECT_NEAR(variants[0].means.at(kApe), (0.4 + (0.2 + 0.4) / 2) / 2, 1e-12);
}

TEST(Summary, GivesBothKittiAverages) {
  const auto variants = summarise(made_results(), {}, kApe);
  const auto& kitti = variants[0].kitti.value();
  EXPECT_EQ(kitti.segments, 110U);
  EXPECT_EQ(kitti.recordings, 2U);
  EXPECT_NEAR(kitti.translation_all_segments_percent, (90 * 2 + 10 * 1 + 10 * 1) / 110.0, 1e-12);
  EXPECT_NEAR(kitti.translation_per_recording_percent, 1.5, 1e-12);
  EXPECT_NEAR(kitti.rotation_per_recording_deg_per_m, 0.015, 1e-12);
}

TEST(Summary, CountsRunsOverBudget) {
  const auto variants = summarise(made_results(), {{kApe, 0.3}}, kApe);
  EXPECT_EQ(variants[0].over_budget, 2U);
  EXPECT_EQ(variants[1].over_budget, 0U);
}

TEST(Summary, TellsRepeatsThatDiffer) {
  Results results = made_results();
  EXPECT_EQ(check_repeats(results, "ape_translation_rmse").groups, 1U);
  EXPECT_EQ(check_repeats(results, "ape_translation_rmse").different, 0U);
  Completion other = made_completion(results.jobs()[4], {});
  other.trajectory_sha256 = "another";
  results.add(other);
  EXPECT_EQ(check_repeats(results, "ape_translation_rmse").different, 1U);
}

TEST(Summary, LatexMarksTheBestAndEscapes) {
  const std::string latex = to_latex(
      leaderboard(summarise(made_results(), {}, kApe), {kApe, "kitti_translation_percent"}));
  EXPECT_THAT(latex, HasSubstr("\\textbf{0.100}"));
  EXPECT_THAT(latex, HasSubstr("KITTI drift, all segments [\\%]"));
  EXPECT_THAT(latex, HasSubstr("KITTI drift, mean of recordings [\\%]"));
  EXPECT_THAT(latex, HasSubstr("steady & 3/3 & 0.350"));
  EXPECT_THAT(latex, Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace traverse::batch
