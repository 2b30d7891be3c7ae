#include "traverse/batch/journal.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "batch/made_plan.hpp"

namespace traverse::batch {
namespace {

using testing::TemporaryFolder;

TEST(Journal, TellsWhatHappenedInOrder) {
  const TemporaryFolder folder;
  const Job job = made_job("street", "floam", 2);
  {
    Journal journal(folder.path());
    journal.began("3 runs");
    journal.started(job, 4711, 1);
    journal.killed(job, 9);
    journal.finished(job, made_completion(job, {}, Outcome::kTimedOut));
  }
  const auto entries = read_journals(folder.path());
  ASSERT_EQ(entries.size(), 4U);
  EXPECT_EQ(entries[0].text, "3 runs");
  EXPECT_EQ(entries[1].pid, 4711);
  EXPECT_EQ(entries[1].text, "street, floam, repeat 2");
  EXPECT_EQ(entries[2].outcome, "signal 9");
  EXPECT_EQ(entries[3].outcome, "timed out");
  EXPECT_EQ(entries[3].id, job.id);
}

TEST(Journal, ALineCutOffIsLeftOutAndTheNextStandsOnItsOwn) {
  const TemporaryFolder folder;
  { Journal(folder.path()).began("first"); }
  const auto file = std::filesystem::directory_iterator(folder.path())->path();
  std::ofstream(file, std::ios::app) << R"({"utc":"2026-)";  // killed here
  { Journal(folder.path()).ended("second"); }
  const auto entries = read_journals(folder.path());
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[0].text, "first");
  EXPECT_EQ(entries[1].text, "second");
}

TEST(Journal, TheFilesOfAllHostsAreReadByTime) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.jsonl")
      << R"({"utc":"2026-01-01T00:00:02Z","event":"ended","host":"a"})"
      << "\n";
  std::ofstream(folder / "b.jsonl")
      << R"({"utc":"2026-01-01T00:00:01Z","event":"began","host":"b"})"
      << "\n";
  const auto entries = read_journals(folder.path());
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[0].host, "b");
}

}  // namespace
}  // namespace traverse::batch
