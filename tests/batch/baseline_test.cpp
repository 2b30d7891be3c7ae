#include "results/baseline.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "traverse/files/input_error.hpp"

#include "batch/made_plan.hpp"

namespace traverse::batch {
namespace {

using testing::TemporaryFolder;

Verdict verdict(const std::vector<std::pair<double, double>>& pairs, bool is_time = false) {
  return judge_change(pairs, is_time).verdict;
}

TEST(Baseline, OnePairIsJudgedByItsSizeAlone) {
  EXPECT_EQ(verdict({{1, 1.009}}), Verdict::kNoChange);
  EXPECT_EQ(verdict({{1, 1.011}}), Verdict::kRegressed);
  EXPECT_EQ(verdict({{1, 0.98}}), Verdict::kImproved);
  EXPECT_EQ(verdict({{1, 1.09}}, true), Verdict::kNoChange);
  EXPECT_EQ(verdict({{1, 1.11}}, true), Verdict::kRegressed);
}

TEST(Baseline, NegativeValuesAreComparedByTheirSize) {
  // Map entropy: lower is better, and it is below zero.
  EXPECT_EQ(verdict({{-2, -2.1}}), Verdict::kImproved);
  EXPECT_EQ(verdict({{-2, -1.9}}), Verdict::kRegressed);
  EXPECT_EQ(verdict({{0, 0}}), Verdict::kNoChange);
  EXPECT_EQ(verdict({{0, 1}}), Verdict::kRegressed);
}

TEST(Baseline, TheIntervalOfThePairedDifferenceIsStudents) {
  // Differences 1, 2, 3: mean 2, standard error 1/sqrt(3), t(0.975, 2) = 4.302653.
  const Change change = judge_change({{10, 11}, {10, 12}, {10, 13}}, false);
  EXPECT_NEAR(change.change_percent, 20, 1e-12);
  ASSERT_TRUE(change.interval_percent);
  EXPECT_NEAR(change.interval_percent->first, 20 - 10 * 4.302653 / std::sqrt(3), 1e-5);
  EXPECT_EQ(change.verdict, Verdict::kNoChange);  // the interval holds zero
  EXPECT_EQ(verdict({{10, 12}, {10, 12.1}, {10, 11.9}}), Verdict::kRegressed);
}

TEST(Baseline, ComparesWithTheResultsOfAnEarlierBatch) {
  const TemporaryFolder folder;
  const std::vector<Job> jobs{made_job("a", "floam"), made_job("a", "floam", 2),
                              made_job("b", "floam"), made_job("c", "floam")};
  Results before(jobs);
  before.add(made_completion(jobs[0], {{"mme", -1.0}}));
  before.add(made_completion(jobs[1], {{"mme", -3.0}}));
  before.add(made_completion(jobs[2], {{"mme", -2.0}}));
  Plan plan;
  plan.metrics = {"mme"};
  write_json(folder / "results.json", plan, before);

  Results now(jobs);
  now.add(made_completion(jobs[0], {{"mme", -2.2}}));
  now.add(made_completion(jobs[1], {{"mme", -2.2}}));
  now.add(made_completion(jobs[2], {{"mme", -5.0}}, Outcome::kCrashed));
  now.add(made_completion(jobs[3], {{"mme", -5.0}}));
  const auto comparison = Baseline(folder.path()).compare(now, {"mme"});
  ASSERT_EQ(comparison.changes.size(), 1U);
  EXPECT_EQ(comparison.changes[0].recordings, 1U);  // b failed, c is new
  EXPECT_NEAR(comparison.changes[0].before, -2, 1e-12);
  EXPECT_EQ(comparison.changes[0].verdict, Verdict::kImproved);
  ASSERT_EQ(comparison.ok.size(), 1U);
  EXPECT_EQ(comparison.ok[0].verdict, Verdict::kRegressed);
  EXPECT_EQ(comparison.unmatched, 1U);
}

TEST(Baseline, AnythingElseIsAnError) {
  const TemporaryFolder folder;
  EXPECT_THROW(Baseline(folder.path()), files::InputError);
  files::write_text(folder / "results.json", "{\"runs\": 3}");
  EXPECT_THROW(Baseline(folder / "results.json"), files::InputError);
}

}  // namespace
}  // namespace traverse::batch
