#include "traverse/batch/execute.hpp"

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/batch/local_executor.hpp"
#include "traverse/batch/results.hpp"
#include "traverse/batch/status.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"

#include "execution/lock.hpp"
#include "temporary_folder.hpp"

namespace traverse::batch {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

/// Jobs that are shell scripts: what a run does is what the test writes.
class Execute : public ::testing::Test {
 protected:
  Execute() { folder_.prepare(); }

  static Job job(const std::string& name, const std::string& script) {
    Job job;
    job.id = name + std::string(64 - name.size(), '0');
    job.recording = name;
    job.pipeline = "shell";
    job.arguments = {"-c", script};
    job.limits.time_s = 20;
    return job;
  }

  std::optional<Completion> run(const Job& job) {
    Journal journal(folder_.journals());
    return execute(job, {"/bin/sh", folder_, journal, stop_});
  }

  std::vector<std::string> names_in_runs() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.runs())) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }

  TemporaryFolder temporary_;
  BatchFolder folder_{temporary_ / "out"};
  std::atomic<bool> stop_{false};
};

TEST_F(Execute, AFinishedRunHasItsNameItsRecordAndNothingElseIsLeft) {
  const Job good = job("good", "echo '1 2 3' > trajectory.tum; echo hello");
  const auto completion = run(good);
  ASSERT_TRUE(completion);
  EXPECT_EQ(completion->outcome, Outcome::kOk);
  EXPECT_EQ(completion->trajectory_sha256.size(), 64U);
  EXPECT_THAT(names_in_runs(), ElementsAre(BatchFolder::run_name(good.id)));
  EXPECT_EQ(files::read_text(folder_.run(good.id) / "log.txt"), "hello\n");
  EXPECT_EQ(read_completion(folder_.completion(good.id)).id, good.id);
}

TEST_F(Execute, EveryEndIsARowWithItsReason) {
  struct Case {
    const char* script;
    Outcome outcome;
    const char* reason;
  };
  for (const Case& c :
       {Case{"echo 'traverse: no such scan' >&2; exit 1", Outcome::kFailed, "no such scan"},
        Case{"kill -SEGV $$", Outcome::kCrashed, "signal 11"},
        Case{"sleep 60", Outcome::kTimedOut, "more than 0.2 s"},
        Case{"exec perl -e 'my $a = \"x\" x 90_000_000; sleep 60'", Outcome::kOutOfMemory,
             "more than 60 MB"},
        Case{"echo \"traverse: out of memory: use less\"; exit 1", Outcome::kOutOfMemory,
             "no more"}}) {
    Job one = job("one", c.script);
    one.limits.memory_mb = 60;
    if (c.outcome == Outcome::kTimedOut) one.limits.time_s = 0.2;
    const auto completion = run(one);
    ASSERT_TRUE(completion);
    EXPECT_EQ(completion->outcome, c.outcome) << c.script << ": " << completion->reason;
    EXPECT_THAT(completion->reason, HasSubstr(c.reason));
    discard(folder_, one);
    EXPECT_THAT(names_in_runs(), ElementsAre());
  }
}

/// What a run says of itself counts, not its exit status alone.
TEST_F(Execute, ARunThatIsLostIsAFailureAndOneThatIsDegradedIsNot) {
  const auto ends = [&](const std::string& status, int exit_status) {
    const Job one = job("one", "mkdir run; echo '{\"status\": \"" + status +
                                   "\", \"reason\": \"0 of 23 frames\"}' > run/run.json; exit " +
                                   std::to_string(exit_status));
    const auto completion = run(one);
    discard(folder_, one);
    return *completion;
  };
  EXPECT_EQ(ends("ok", 0).outcome, Outcome::kOk);
  EXPECT_EQ(ends("lost", 1).outcome, Outcome::kLost);
  EXPECT_EQ(ends("lost", 1).reason, "0 of 23 frames");
  EXPECT_EQ(ends("degraded", 0).outcome, Outcome::kDegraded);
  EXPECT_EQ(ends("degraded", 0).reason, "0 of 23 frames");
  EXPECT_EQ(ends("degraded", 1).outcome, Outcome::kFailed);  // over its budget, say
  EXPECT_EQ(ends("failed", 1).outcome, Outcome::kFailed);
}

TEST_F(Execute, WhatAKilledRunWasWritingIsNoResult) {
  Job slow = job("slow", "mkdir .run.traverse-work; touch .run.traverse-work/map.ply; sleep 60");
  slow.limits.time_s = 0.2;
  EXPECT_EQ(run(slow)->outcome, Outcome::kTimedOut);
  EXPECT_TRUE(fs::exists(folder_.run(slow.id) / "log.txt"));
  EXPECT_FALSE(fs::exists(folder_.run(slow.id) / ".run.traverse-work"));
}

TEST_F(Execute, ARunKilledFromOutsideIsBegunAgain) {
  const std::string marker = (temporary_ / "marker").string();
  const Job once =
      job("once", "[ -e " + marker + " ] && exit 0; touch " + marker + "; kill -KILL $$");
  const auto completion = run(once);
  ASSERT_TRUE(completion);
  EXPECT_EQ(completion->outcome, Outcome::kOk);
  EXPECT_EQ(completion->attempts, 2);

  Job always = job("always", "kill -KILL $$");
  always.limits.attempts = 3;
  const auto gave_up = run(always);
  EXPECT_EQ(gave_up->outcome, Outcome::kCrashed);
  EXPECT_EQ(gave_up->attempts, 3);
  EXPECT_THAT(gave_up->reason, HasSubstr("3 attempts"));
}

TEST_F(Execute, ARunThatEndedInOrderOnARequestIsBegunAgain) {
  const std::string marker = (temporary_ / "marker").string();
  const auto completion =
      run(job("asked", "mkdir run; [ -e " + marker +
                           " ] && { echo '{\"status\": \"ok\"}' > run/run.json; exit 0; }; "
                           "touch " +
                           marker + "; echo '{\"status\": \"interrupted\"}' > run/run.json"));
  EXPECT_EQ(completion->attempts, 2);
}

TEST_F(Execute, AStoppedRunLeavesNothing) {
  stop_ = true;
  EXPECT_FALSE(run(job("stopped", "sleep 60")));
  EXPECT_THAT(names_in_runs(), ElementsAre());
}

TEST_F(Execute, WhoIsLaterWithTheSameRunTakesTheEarlierResult) {
  const Job same = job("same", "echo first");
  const auto first = run(same);
  Job later = job("same", "exit 1");
  EXPECT_EQ(run(later)->outcome, Outcome::kOk);
  EXPECT_THAT(names_in_runs(), ElementsAre(BatchFolder::run_name(same.id)));
}

TEST_F(Execute, AnOutdatedOrBrokenRunIsReplaced) {
  Job slow = job("slow", "sleep 60");
  slow.limits.time_s = 0.1;
  EXPECT_EQ(run(slow)->outcome, Outcome::kTimedOut);
  slow.limits.time_s = 20;
  slow.arguments.back() = "true";
  EXPECT_EQ(run(slow)->outcome, Outcome::kOk);
  files::write_text(folder_.completion(slow.id), "{\"id\": ");
  EXPECT_EQ(run(slow)->outcome, Outcome::kOk);
  EXPECT_EQ(read_completion(folder_.completion(slow.id)).outcome, Outcome::kOk);
}

TEST_F(Execute, WhatDeadBatchesLeftIsRemovedAndWhatLivingOnesDoIsNot) {
  const auto work = [&](const std::string& host, const std::string& pid) {
    const fs::path folder =
        folder_.runs() / ("." + std::string(16, 'a') + "." + host + "." + pid + ".partial");
    fs::create_directory(folder);
    files::write_text(folder / "result.json", to_json(Completion{}));
    return folder;
  };
  char name[256]{};
  ::gethostname(name, sizeof name - 1);
  const fs::path dead = work(name, "999999999");
  const fs::path living = work(name, "1");
  const fs::path elsewhere = work("other-host", "999999999");
  remove_abandoned(folder_);
  EXPECT_FALSE(fs::exists(dead));
  EXPECT_TRUE(fs::exists(living));
  EXPECT_TRUE(fs::exists(elsewhere));
}

TEST_F(Execute, LocalRunsGoOnWhenSomeAreNotOk) {
  std::vector<Job> jobs;
  for (int i = 0; i < 12; ++i) {
    jobs.push_back(job("job" + std::to_string(i), i % 3 == 0 ? "exit 1" : "true"));
  }
  Journal journal(folder_.journals());
  Results results(jobs);
  ExecutorEvents events;
  events.finished = [&](const Job&, const Completion& completion) { results.add(completion); };
  run_locally(jobs, 3, {"/bin/sh", folder_, journal, stop_}, events);
  EXPECT_EQ(count_outcomes(results)[Outcome::kOk], 8U);
  EXPECT_EQ(count_outcomes(results)[Outcome::kFailed], 4U);

  Results read_again(jobs);
  read_again.load(folder_, [](const Completion& c) { return c.outcome != Outcome::kOk; });
  EXPECT_EQ(read_again.pending().size(), 4U);
}

TEST_F(Execute, AnErrorOfTheBatchItselfEndsItAndIsTold) {
  std::vector<Job> jobs{job("one", "true"), job("two", "true"), job("three", "sleep 60")};
  Journal journal(folder_.journals());
  ExecutorEvents events;
  events.finished = [](const Job&, const Completion&) { throw std::runtime_error("disk full"); };
  EXPECT_THROW(run_locally(jobs, 2, {"/bin/sh", folder_, journal, stop_}, events),
               std::runtime_error);
}

TEST_F(Execute, StatusTellsWhatIsDoneFromTheFolderAlone) {
  const std::vector<Job> jobs{job("good", "true"), job("bad", "exit 1"), job("later", "true")};
  write_jobs(folder_.jobs(), jobs);
  run(jobs[0]);
  run(jobs[1]);
  const BatchStatus status = read_status(folder_);
  EXPECT_EQ(status.distinct, 3U);
  EXPECT_EQ(status.finished, 2U);
  EXPECT_EQ(status.outcomes.at("ok"), 1U);
  EXPECT_EQ(status.outcomes.at("failed"), 1U);
  EXPECT_TRUE(status.running.empty());
  EXPECT_FALSE(status.at_work);
  const BatchLock lock(folder_.path / "lock");
  EXPECT_TRUE(read_status(folder_).at_work);
}

TEST_F(Execute, ALockKeepsASecondBatchOutAndGoesWithItsOwner) {
  {
    const BatchLock lock(folder_.path / "lock");
    try {
      const BatchLock second(folder_.path / "lock");
      FAIL();
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr(std::to_string(::getpid())));
    }
  }
  const BatchLock again(folder_.path / "lock");  // the file is there, nobody holds it
}

}  // namespace
}  // namespace traverse::batch
