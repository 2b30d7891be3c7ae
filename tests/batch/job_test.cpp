#include "traverse/batch/job.hpp"

#include <algorithm>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/input_error.hpp"

#include "batch/made_plan.hpp"

namespace traverse::batch {
namespace {

using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using testing::TemporaryFolder;

constexpr const char* kPlan =
    "recordings: [a.rawlog, b.rawlog]\npipelines: [floam]\nrepeats: 2\n"
    "grid: {solver.huber_m: [0.1, 0.2]}\nlimits: {threads: 2}\n";

class JobTest : public ::testing::Test {
 protected:
  JobTest() {
    files::write_text(folder_ / "a.rawlog", "");
    files::write_text(folder_ / "b.rawlog", "");
  }
  std::vector<Job> jobs(const std::string& yaml, const std::string& program = "1.0",
                        const std::string& digest_of_a = "aaa") const {
    return make_jobs(plan_of(folder_, yaml), {{"a", digest_of_a}, {"b", "bbb"}}, program,
                     TRAVERSE_SHARE_DIR);
  }
  static std::set<std::string> ids(const std::vector<Job>& jobs) {
    std::set<std::string> ids;
    for (const Job& job : jobs) ids.insert(job.id);
    return ids;
  }
  TemporaryFolder folder_;
};

TEST_F(JobTest, EachCombinationIsOneJobWithItsCommand) {
  const std::vector<Job> all = jobs(kPlan);
  ASSERT_EQ(all.size(), 8U);
  EXPECT_EQ(ids(all).size(), 8U);
  EXPECT_EQ(all[3].title(), "a, floam solver.huber_m=0.2, repeat 2");
  EXPECT_THAT(all[3].arguments,
              IsSupersetOf({"run", (folder_ / "a.rawlog").c_str(), "--set", "solver.huber_m=0.2",
                            "--threads", "2", "-o", "run"}));
}

TEST_F(JobTest, APipelineStatesFactsOverThoseOfTheRecording) {
  const auto plan_with = [](const std::string& statements) {
    return "recordings: [{path: a.rawlog, statements: {period_s: 1}}]\npipelines: [{preset: floam" +
           statements + "}]\n";
  };
  const auto stated = jobs(plan_with(", statements: {period_s: 2}"));
  const auto& words = stated.at(0).arguments;
  const auto first = std::find(words.begin(), words.end(), "period_s=1");
  EXPECT_NE(std::find(first, words.end(), "period_s=2"), words.end()) << "the later wins";
  EXPECT_NE(stated.at(0).id, jobs(plan_with("")).at(0).id);
}

TEST_F(JobTest, TheIdFollowsRecordingConfigurationAndProgramAlone) {
  const auto before = ids(jobs(kPlan));
  EXPECT_EQ(ids(jobs(kPlan)), before);
  EXPECT_EQ(ids(jobs(std::string(kPlan) + "budgets: {mme: 1}\ndescription: other\n")), before);
  const auto others = [&](const std::set<std::string>& now) {
    std::size_t count = 0;
    for (const std::string& id : now) count += before.contains(id) ? 0 : 1;
    return count;
  };
  EXPECT_EQ(others(ids(jobs(kPlan, "1.1"))), 8U);
  EXPECT_EQ(others(ids(jobs(kPlan, "1.0", "changed"))), 4U);
  std::string plan = kPlan;
  plan.replace(plan.find("0.2]"), 4, "0.3]");
  EXPECT_EQ(others(ids(jobs(plan))), 4U);
}

TEST_F(JobTest, RunsThatAreTheSameHaveOneId) {
  // 0.1 is what the preset says itself.
  const std::vector<Job> all = jobs(
      "recordings: [a.rawlog]\npipelines:\n  - floam\n"
      "  - {preset: floam, name: again, grid: {solver.huber_m: [0.1, 0.2]}}\n");
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].id, all[1].id);
  EXPECT_EQ(distinct(all).size(), 2U);
}

TEST_F(JobTest, AListOfJobsReadsBackAndCanBeReadInParts) {
  const std::vector<Job> all = jobs(kPlan);
  write_jobs(folder_ / "jobs.jsonl", all);
  const std::vector<Job> part = read_jobs(folder_ / "jobs.jsonl", 3, 2);
  ASSERT_EQ(part.size(), 2U);
  EXPECT_EQ(part[1].id, all[4].id);
  EXPECT_EQ(part[1].arguments, all[4].arguments);
  EXPECT_EQ(part[1].limits, all[4].limits);
  EXPECT_EQ(read_jobs(folder_ / "jobs.jsonl").size(), 8U);
  files::write_text(folder_ / "bad.jsonl", "{}\n");
  EXPECT_THROW(read_jobs(folder_ / "bad.jsonl"), files::InputError);
}

}  // namespace
}  // namespace traverse::batch
