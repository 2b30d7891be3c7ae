#include "results/ranking.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/batch/metric.hpp"

#include "batch/made_plan.hpp"
#include "results/report.hpp"

namespace traverse::batch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kFigure = "ape_translation_rmse";

/// Runs of systems on recordings, one each.
class MadeRuns {
 public:
  void add(const std::string& recording, const std::string& system, double error_m, double wall_s,
           Outcome outcome = Outcome::kOk, int repeat = 1) {
    Job job = made_job(recording, system, repeat);
    std::vector<MetricValue> metrics;
    if (is_usable(outcome)) metrics = {{kFigure, error_m}, {"wall_s", wall_s}};
    completions_.push_back(made_completion(job, metrics, outcome));
    jobs_.push_back(std::move(job));
  }
  Results results() const {
    Results results(jobs_);
    for (const Completion& completion : completions_) results.add(completion);
    return results;
  }

 private:
  std::vector<Job> jobs_;
  std::vector<Completion> completions_;
};

TEST(Ranking, LettersAreSharedByThoseThatDoNotDiffer) {
  // Of four in a row the neighbours are alike: ab, bc, cd.
  std::vector<std::vector<bool>> differ(4, std::vector<bool>(4, false));
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) differ[i][j] = i + 1 < j || j + 1 < i;
  }
  EXPECT_THAT(compact_letters(differ), ElementsAre("a", "ab", "bc", "c"));
  const std::vector<std::vector<bool>> alike(3, std::vector<bool>(3, false));
  EXPECT_THAT(compact_letters(alike), ElementsAre("a", "a", "a"));
  std::vector<std::vector<bool>> all(3, std::vector<bool>(3, true));
  for (std::size_t i = 0; i < 3; ++i) all[i][i] = false;
  EXPECT_THAT(compact_letters(all), ElementsAre("a", "b", "c"));
}

TEST(Ranking, WhoIsBetterEverywhereIsToldApartAndTwinsAreNot) {
  MadeRuns runs;
  for (int r = 0; r < 12; ++r) {
    const std::string recording = "drive " + std::to_string(r);
    const double base = 0.1 + 0.01 * r;
    runs.add(recording, "worst", 5 * base, 1);
    runs.add(recording, "twin", base * (r % 2 == 0 ? 2 : 2.1), 20);
    runs.add(recording, "other twin", base * (r % 2 == 0 ? 2.1 : 2), 30);
    runs.add(recording, "best", base, 10);
  }
  const auto ranking = rank_variants(runs.results(), kFigure);
  ASSERT_TRUE(ranking);
  ASSERT_EQ(ranking->variants.size(), 4U);
  EXPECT_EQ(ranking->variants[0].variant, "best");
  EXPECT_EQ(ranking->variants[0].letters, "a");
  EXPECT_EQ(ranking->variants[1].letters, "b");
  EXPECT_EQ(ranking->variants[2].letters, "b");
  EXPECT_EQ(ranking->variants[3].letters, "c");
  EXPECT_DOUBLE_EQ(ranking->variants[1].mean_rank, 2.5);
  EXPECT_LT(ranking->variants[1].interval->first, 2.5);
  EXPECT_GT(ranking->variants[1].interval->second, 2.5);
  EXPECT_EQ(ranking->variants[0].interval->second, 1);
  // The worst is the fastest, and so on the front; the twins are neither.
  EXPECT_TRUE(ranking->variants[0].is_on_front);
  EXPECT_FALSE(ranking->variants[1].is_on_front);
  EXPECT_FALSE(ranking->variants[2].is_on_front);
  EXPECT_TRUE(ranking->variants[3].is_on_front);
}

TEST(Ranking, WhoFailsIsLastThereAndTiesShareTheirRank) {
  MadeRuns runs;
  runs.add("one", "a", 1, 1);
  runs.add("one", "b", 1, 1);
  runs.add("one", "c", 2, 1);
  runs.add("two", "a", 0.1, 1, Outcome::kCrashed);
  runs.add("two", "b", 5, 1);
  runs.add("two", "c", 6, 1);
  const auto ranking = rank_variants(runs.results(), kFigure);
  ASSERT_TRUE(ranking);
  EXPECT_EQ(ranking->variants[0].variant, "b");
  EXPECT_DOUBLE_EQ(ranking->variants[0].mean_rank, 1.25);
  EXPECT_DOUBLE_EQ(ranking->variants[1].mean_rank, 2.25);
  EXPECT_EQ(ranking->variants[1].variant, "a");
  EXPECT_EQ(ranking->variants[1].recordings, 1U);
  EXPECT_FALSE(ranking->variants[0].interval) << "two recordings tell no interval";
  EXPECT_TRUE(ranking->variants[0].letters.empty());
}

TEST(Ranking, APageOfThreeThousandRunsHasAllOfThem) {
  MadeRuns runs;
  Plan plan;
  plan.metrics = {kFigure, "wall_s"};
  for (int r = 0; r < 30; ++r) {
    plan.recordings.emplace_back();
    plan.recordings.back().name = "drive " + std::to_string(r);
    for (int s = 0; s < 20; ++s) {
      for (int repeat = 1; repeat <= 5; ++repeat) {
        const double error = 0.1 * (1 + s / 3) * (1 + 0.3 * ((r * 7 + s * 5) % 11));
        runs.add("drive " + std::to_string(r), "system " + std::to_string(s), error, 30 - s,
                 (r + s) % 37 == 0 ? Outcome::kCrashed : Outcome::kOk, repeat);
      }
    }
  }
  for (int s = 0; s < 20; ++s) {
    plan.pipelines.emplace_back();
    plan.pipelines.back().name = "system " + std::to_string(s);
  }
  const Results results = runs.results();
  const auto variants = summarise(results, plan.budgets, kFigure);
  const std::optional<BaselineComparison> baseline;
  const std::string page = batch_page({plan, results, variants, baseline, {}, {}, {}},
                                      std::string(TRAVERSE_SOURCE_DIR) + "/reports/templates");
  EXPECT_LT(page.size(), 8'000'000U);
  EXPECT_THAT(page, HasSubstr("id=\"ranking\""));
  EXPECT_THAT(page, HasSubstr("What each was told"));
}

}  // namespace
}  // namespace traverse::batch
