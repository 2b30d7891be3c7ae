#include "execution/run_process.hpp"

#include <atomic>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/text_file.hpp"

#include "temporary_folder.hpp"

namespace traverse::batch {
namespace {

using ::testing::HasSubstr;
using Cause = ProcessEnd::Cause;
using testing::TemporaryFolder;

class RunProcess : public ::testing::Test {
 protected:
  ProcessStart shell(const std::string& text) const {
    return {"/bin/sh", {"-c", text}, folder_.path(), folder_ / "log"};
  }
  TemporaryFolder folder_;
  std::atomic<bool> stop_{false};
};

TEST_F(RunProcess, KeepsStatusOutputAndFolder) {
  const ProcessEnd end = run_process(shell("pwd; echo words >&2; exit 3"), stop_);
  EXPECT_EQ(end.cause, Cause::kItself);
  EXPECT_EQ(end.exit_status, 3);
  EXPECT_EQ(end.signal, 0);
  EXPECT_GT(end.peak_memory_mb, 0);
  EXPECT_EQ(files::read_text(folder_ / "log"), folder_.path().string() + "\nwords\n");
}

TEST_F(RunProcess, TellsTheSignalOfACrash) {
  EXPECT_EQ(run_process(shell("kill -SEGV $$"), stop_).signal, SIGSEGV);
}

TEST_F(RunProcess, EndsWithAllItStartedAtTheTimeLimit) {
  ProcessStart start = shell("sleep 60 & echo $!; wait");
  start.time_limit_s = 0.2;
  const ProcessEnd end = run_process(start, stop_);
  EXPECT_EQ(end.cause, Cause::kTimeLimit);
  EXPECT_LT(end.wall_s, 30);
  const int child = std::stoi(files::read_text(folder_ / "log"));
  for (int i = 0; i < 100 && ::kill(child, 0) == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_NE(::kill(child, 0), 0);
}

TEST_F(RunProcess, EndsAtTheMemoryLimit) {
  // The shell doubles a text until it is beyond the limit.
  ProcessStart start = shell("a=0123456789abcdef; while :; do a=$a$a; done");
  start.memory_limit_mb = 60;
  start.time_limit_s = 30;
  EXPECT_EQ(run_process(start, stop_).cause, Cause::kMemoryLimit);
}

TEST_F(RunProcess, MemoryThatCameAndWentBetweenTwoLooksCounts) {
  ProcessStart start = shell("");
  start.program = "/usr/bin/perl";
  start.arguments = {"-e", "my $a = 'x' x 80_000_000;"};
  start.memory_limit_mb = 60;
  EXPECT_EQ(run_process(start, stop_).cause, Cause::kMemoryLimit);
}

TEST_F(RunProcess, StopsWhenAsked) {
  std::jthread asker([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    stop_ = true;
  });
  EXPECT_EQ(run_process(shell("sleep 60"), stop_).cause, Cause::kStopped);
}

TEST_F(RunProcess, AProgramThatIsNotThereIsAStatusOfItsOwn) {
  ProcessStart start = shell("");
  start.program = "/no/such/program";
  EXPECT_EQ(run_process(start, stop_).exit_status, 127);
}

}  // namespace
}  // namespace traverse::batch
