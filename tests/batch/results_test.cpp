#include "traverse/batch/results.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/files/text_file.hpp"

#include "batch/made_plan.hpp"

namespace traverse::batch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

TEST(Results, OneRowARunWithEveryMetricThatAnyRunHas) {
  const TemporaryFolder folder;
  std::vector<Job> jobs{made_job("a", "floam"), made_job("b, \"quoted\"", "floam"),
                        made_job("c", "floam")};
  jobs[0].id = "0a";
  jobs[1].id = "0b";
  Results results(jobs);
  results.add(made_completion(results.jobs()[0], {{"mme", -1.5}, {"wall_s", 2}}));
  Completion bad = made_completion(results.jobs()[1], {{"wall_s", 3}}, Outcome::kCrashed);
  bad.reason = "signal 11";
  results.add(bad);
  write_csv(folder / "results.csv", results);
  EXPECT_EQ(files::read_text(folder / "results.csv"),
            "recording,pipeline,settings,repeat,outcome,reason,id,trajectory_sha256,mme,wall_s,"
            "attempts,host,started_utc\n"
            "a,floam,,1,ok,,0a,,-1.5,2,1,,\n"
            "\"b, \"\"quoted\"\"\",floam,,1,crashed,signal 11,0b,,,3,1,,\n")
      << "the job that is not made has no row";
}

TEST(Results, NoCellIsWhatASpreadsheetComputes) {
  const TemporaryFolder folder;
  Results results({made_job("=cmd|'/c calc'!A1", "@floam")});
  results.add(made_completion(results.jobs()[0], {{"mme", -1.5}}));
  write_csv(folder / "results.csv", results);
  EXPECT_THAT(files::read_text(folder / "results.csv"),
              HasSubstr("\n\"'=cmd|'/c calc'!A1\",\"'@floam\",,1,ok,,"));
}

TEST(Results, JsonHoldsTheRunsThatAreNotMadeToo) {
  const TemporaryFolder folder;
  Plan plan;
  plan.metrics = {"mme"};
  plan.budgets = {{"mme", -2}};
  Results results({made_job("a", "floam"), made_job("b", "floam")});
  results.add(made_completion(results.jobs()[0], {{"mme", -1.5}}));
  write_json(folder / "results.json", plan, results);
  const auto json = nlohmann::json::parse(files::read_text(folder / "results.json"));
  EXPECT_EQ(json["runs"][0]["metrics"]["mme"], -1.5);
  EXPECT_EQ(json["runs"][0]["broken_budgets"][0], "mme");
  EXPECT_TRUE(json["runs"][1]["outcome"].is_null());
  EXPECT_EQ(results.pending().size(), 1U);
}

TEST(Results, ABudgetIsBrokenByWhatIsAboveIt) {
  const Completion completion =
      made_completion(made_job("a", "floam"), {{"mme", 1}, {"wall_s", 5}});
  EXPECT_THAT(broken_budgets(completion, {{"mme", 1}, {"wall_s", 4.9}, {"cpu_s", 0}}),
              ElementsAre("wall_s"));
}

}  // namespace
}  // namespace traverse::batch
