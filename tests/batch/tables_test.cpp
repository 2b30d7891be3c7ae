#include "results/tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/input_error.hpp"

#include "batch/made_plan.hpp"

namespace traverse::batch {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::TemporaryFolder;

constexpr const char* kRmse = "ape_translation_rmse";

/// Two recordings through two pipelines, the second of which only one recording takes.
class Tables : public ::testing::Test {
 protected:
  Tables() {
    files::write_text(folder_ / "a.rawlog", "");
    files::write_text(folder_ / "b.rawlog", "");
  }
  Plan plan(const std::string& tables) {
    return plan_of(folder_,
                   "title: Two drives\ndescription: How they went.\n"
                   "recordings: [a.rawlog, {path: b.rawlog, text: It rains., pipelines: [floam]}]\n"
                   "pipelines: [floam, {name: other, preset: floam}]\n"
                   "metrics: [ape_translation_rmse]\ntables:\n" +
                       tables);
  }
  std::string message_of(const std::string& tables) {
    try {
      plan(tables);
    } catch (const files::InputError& error) {
      return error.what();
    }
    return "no error";
  }
  Results results() const {
    Results results({made_job("a", "floam"), made_job("a", "floam", 2), made_job("a", "other"),
                     made_job("b", "floam")});
    const auto& jobs = results.jobs();
    results.add(made_completion(jobs[0], {{kRmse, 0.125}, {"end_error_percent", -0.5}}));
    results.add(made_completion(jobs[1], {{kRmse, 0.375}}));
    Completion lost = made_completion(jobs[2], {}, Outcome::kFailed);
    lost.reason = "no scan | none";
    results.add(lost);
    return results;
  }

  TemporaryFolder folder_;
};

TEST_F(Tables, StandRecordingByRecordingWithTheirTexts) {
  const Plan planned = plan(
      "  - {title: First, text: Of all., head: preset, columns: [{metric: ape_translation_rmse, "
      "title: 'APE [m]', decimals: 2}, {metrics: [ape_translation_rmse, end_error_percent], "
      "title: both, decimals: 1}]}\n"
      "  - {title: Second, pipelines: [floam]}\n");
  EXPECT_EQ(tables_markdown(planned, shown_tables(planned, results()), "Made by hand."),
            "# Two drives\n\nMade by hand.\n\nHow they went.\n"
            "\n## a\n\n### First\n\nOf all.\n\n"
            "| preset | APE [m] | both |\n|---|---|---|\n"
            "| floam | 0.25 | 0.2 / -0.5 |\n"
            "| other | failed: no scan \\| none |  |\n"
            "\n### Second\n\n|  | APE [m] |\n|---|---|\n| floam | 0.250 |\n"
            "\n## b\n\nIt rains.\n\n### First\n\nOf all.\n\n"
            "| preset | APE [m] | both |\n|---|---|---|\n| floam | not made |  |\n"
            "\n### Second\n\n|  | APE [m] |\n|---|---|\n| floam | not made |\n");
}

TEST_F(Tables, OfRecordingsAndOfMeans) {
  Results all = results();
  all.add(made_completion(all.jobs()[3], {{kRmse, 0.75}}));
  const Plan planned = plan(
      "  - {title: Drives, rows: recordings, head: drive}\n"
      "  - {title: Means, rows: means, pipelines: [floam]}\n");
  const std::string text = tables_markdown(planned, shown_tables(planned, all), "");
  EXPECT_THAT(text, HasSubstr("## Drives\n\n### floam\n\n| drive | APE [m] |\n|---|---|\n"
                              "| a | 0.250 |\n| b | 0.750 |\n\n### other\n"));
  EXPECT_THAT(text, HasSubstr("## Means\n\n|  | APE [m] |\n|---|---|\n| floam | 0.500 |\n"));
  EXPECT_THAT(text, Not(HasSubstr("| b | 0.750 |\n| other"))) << "b does not go through other";
}

TEST_F(Tables, WrongOnesAreRefusedWithTheirLine) {
  EXPECT_THAT(message_of("  - {title: T, pipelines: [flaom]}\n"),
              AllOf(HasSubstr("line 7"), HasSubstr("pipeline"), HasSubstr("'flaom'")));
  EXPECT_THAT(message_of("  - {title: T, recordings: [c]}\n"), HasSubstr("recording"));
  EXPECT_THAT(message_of("  - {title: T, columns: [ape]}\n"), HasSubstr("traverse batch metrics"));
  EXPECT_THAT(message_of("  - {title: T, columns: [{title: x}]}\n"), HasSubstr("a 'metric'"));
  EXPECT_THAT(message_of("  - {title: T, rows: columns}\n"), HasSubstr("pipelines"));
  EXPECT_THAT(message_of("  - {titel: T}\n"), HasSubstr("titel"));
}

TEST_F(Tables, ARecordingGoesThroughThePipelinesItChooses) {
  const Plan planned = plan("  - T\n");
  EXPECT_EQ(count_runs(planned), 3U);
  EXPECT_THAT(describe(planned), HasSubstr("where they are chosen"));
  const auto jobs = make_jobs(planned, {{"a", "1"}, {"b", "2"}}, "program", TRAVERSE_SHARE_DIR);
  std::vector<std::string> titles;
  for (const Job& job : jobs) titles.push_back(job.title());
  EXPECT_THAT(titles, ElementsAre("a, floam", "a, other", "b, floam"));
}

}  // namespace
}  // namespace traverse::batch
