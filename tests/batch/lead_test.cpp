#include "results/lead.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/evaluation/evaluate.hpp"
#include "traverse/evaluation/json.hpp"
#include "traverse/files/atomic_file.hpp"

#include "batch/made_plan.hpp"
#include "results/ranking.hpp"

namespace traverse::batch {
namespace {

using ::testing::HasSubstr;

constexpr const char* kApe = "ape_translation_rmse";

/// A batch of two pipelines on so many recordings.
class Leads : public ::testing::Test {
 protected:
  Leads() { folder_.prepare(); }

  /// \param errors of a run on a recording
  template <typename Errors>
  void add(const std::string& recording, const std::string& pipeline, const Errors& errors,
           Outcome outcome = Outcome::kOk) {
    const Job job = made_job(recording, pipeline);
    geometry::Trajectory estimate;
    geometry::Trajectory reference;
    for (std::size_t i = 0; i < 300; ++i) {
      geometry::Pose3 pose;
      pose.translation = {30 * std::sin(0.05 * static_cast<double>(i)),
                          30 * std::cos(0.05 * static_cast<double>(i)), 0};
      const auto stamp = geometry::Stamp::from_seconds(0.1 * static_cast<double>(i));
      reference.push_back(stamp, pose);
      pose.translation.z() += errors(i);
      estimate.push_back(stamp, pose);
    }
    const auto evaluation =
        evaluation::evaluate(estimate, reference, evaluation::run_evaluation_options());
    const std::filesystem::path run = folder_.run(job.id);
    std::filesystem::create_directories(run);
    files::write_text(run / "evaluation.json", evaluation::to_json(evaluation));
    jobs_.push_back(job);
    completions_.push_back(made_completion(
        job, {{kApe, evaluation.comparison->ape.front().statistics.rmse}}, outcome));
  }

  std::optional<Lead> lead() const {
    Results results(jobs_);
    for (const Completion& completion : completions_) results.add(completion);
    return find_lead(kApe, results, summarise(results, {}, kApe),
                     [this](const Job& job) { return folder_.run(job.id); });
  }

  testing::TemporaryFolder temporary_;
  BatchFolder folder_{temporary_ / "out"};
  std::vector<Job> jobs_;
  std::vector<Completion> completions_;
};

double wave(std::size_t i, double phase) {
  return std::sin(0.37 * static_cast<double>(i) + phase) +
         std::sin(1.13 * static_cast<double>(i) + 2 * phase);
}

TEST_F(Leads, NothingIsComparedAcrossRecordings) {
  add("one", "loam", [](std::size_t i) { return 0.05 * wave(i, 0); });
  add("two", "floam", [](std::size_t i) { return 0.06 * wave(i, 1); });
  const auto found = lead();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->second, "");
  EXPECT_THAT(to_text(*found), ::testing::Not(HasSubstr("more")));
}

TEST_F(Leads, TwoThatAreATenthOfAMillimetreApartAreTied) {
  add("one", "loam", [](std::size_t i) { return 0.05 * wave(i, 0); });
  add("one", "floam", [](std::size_t i) { return 0.0502 * wave(i, 1); });
  add("two", "loam", [](std::size_t i) { return 0.0502 * wave(i, 1); });
  add("two", "floam", [](std::size_t i) { return 0.0501 * wave(i, 0); });
  ASSERT_TRUE(lead());
  ASSERT_TRUE(lead()->interval);
  EXPECT_FALSE(lead()->is_sure());
  EXPECT_LT(lead()->difference, 3e-4);
  EXPECT_THAT(to_text(*lead()), HasSubstr("are tied at"));
  EXPECT_THAT(to_text(*lead()), Not(HasSubstr("leads")));
}

TEST_F(Leads, OneThatIsBetterAllAlongLeadsOnASingleRecording) {
  add("one", "loam", [](std::size_t i) { return 0.05 * wave(i, 0); });
  add("one", "floam", [](std::size_t i) { return 0.2 * wave(i, 1); });
  ASSERT_TRUE(lead()->interval);
  EXPECT_TRUE(lead()->is_sure());
  EXPECT_EQ(lead()->first, "loam");
  EXPECT_THAT(to_text(*lead()), HasSubstr("loam leads with"));
  EXPECT_THAT(to_text(*lead()), HasSubstr("95 %"));
}

TEST_F(Leads, OfThreeRecordingsTheScatterBetweenThemCounts) {
  const std::vector<double> better{0.5, 1.02, 1.6};  // times as large: now the one, now the other
  for (std::size_t k = 0; k < better.size(); ++k) {
    const std::string recording = std::to_string(k);
    add(recording, "loam", [](std::size_t i) { return 0.1 * wave(i, 0); });
    add(recording, "floam", [&](std::size_t i) { return 0.1 * better[k] * wave(i, 0); });
  }
  EXPECT_FALSE(lead()->is_sure());
  EXPECT_THAT(to_text(*lead()), HasSubstr("tied"));
}

TEST_F(Leads, MoreRunsThatAreOkLeadByThemselves) {
  add("one", "loam", [](std::size_t i) { return 0.05 * wave(i, 0); });
  add("one", "floam", [](std::size_t i) { return 0.02 * wave(i, 1); });
  add("two", "loam", [](std::size_t i) { return 0.05 * wave(i, 0); });
  add(
      "two", "floam", [](std::size_t i) { return 0.02 * wave(i, 1); }, Outcome::kLost);
  EXPECT_EQ(lead()->first, "loam");
  EXPECT_THAT(to_text(*lead()), HasSubstr("by more runs that are ok"));
}

TEST_F(Leads, ThatMoreOfItsRunsAreDegradedMakesAFigureNoWorse) {
  const std::vector<double> worse{2, 2.2, 2.1};
  for (std::size_t k = 0; k < worse.size(); ++k) {
    const std::string recording = std::to_string(k);
    add(recording, "loam", [&](std::size_t i) { return 0.05 * worse[k] * wave(i, 0); });
    add(
        recording, "floam", [](std::size_t i) { return 0.05 * wave(i, 0); }, Outcome::kDegraded);
  }
  EXPECT_EQ(lead()->first, "floam");
  EXPECT_TRUE(lead()->is_sure());
  EXPECT_GT(lead()->difference, 0);
  EXPECT_EQ(lead()->better_on, 3U);
  EXPECT_EQ(lead()->recordings, 3U);
}

TEST_F(Leads, AloneNothingLeads) {
  add("one", "loam", [](std::size_t i) { return 0.05 * wave(i, 0); });
  EXPECT_THAT(to_text(*lead()), HasSubstr("loam has"));
  jobs_.clear();
  EXPECT_FALSE(lead());
}

TEST_F(Leads, WithoutTheErrorsOfTheRunsThereIsNoInterval) {
  add("one", "loam", [](std::size_t i) { return 0.05 * wave(i, 0); });
  add("one", "floam", [](std::size_t i) { return 0.2 * wave(i, 1); });
  std::filesystem::remove(folder_.run(jobs_[0].id) / "evaluation.json");
  EXPECT_FALSE(lead()->is_sure());
  EXPECT_THAT(to_text(*lead()), HasSubstr("no interval"));
}

TEST_F(Leads, OfFewRecordingsTheRankingTellsWhatDiffersAlongThem) {
  add("a", "floam", [](std::size_t i) { return 0.05 * std::sin(0.7 * static_cast<double>(i)); });
  add("a", "loam", [](std::size_t i) { return 0.0501 * std::sin(0.9 * static_cast<double>(i)); });
  add("a", "bad", [](std::size_t i) { return 0.5 * std::sin(0.7 * static_cast<double>(i)); });
  Results results(jobs_);
  for (const Completion& completion : completions_) results.add(completion);
  const auto ranking =
      rank_variants(results, kApe, [this](const Job& job) { return folder_.run(job.id); });
  ASSERT_EQ(ranking->variants.size(), 3U);
  const auto& bad = ranking->variants[2];
  EXPECT_EQ(bad.variant, "bad");
  EXPECT_FALSE(ranking->variants[0].over_first);
  EXPECT_GT(bad.over_first->low, 0);
  EXPECT_EQ(ranking->variants[0].letters, ranking->variants[1].letters);
  EXPECT_NE(ranking->variants[0].letters, bad.letters);
  EXPECT_FALSE(bad.interval) << "of mean ranks there is none for one recording";
  EXPECT_FALSE(rank_variants(results, kApe)->variants[2].over_first) << "without the runs";
}

}  // namespace
}  // namespace traverse::batch
