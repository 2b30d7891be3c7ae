#include "execution/command.hpp"

#include <atomic>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"

#include "temporary_folder.hpp"

namespace traverse::batch {
namespace {

using ::testing::HasSubstr;

constexpr const char* kTimedOut =
    "sbatch: error: Batch job submission failed: Socket timed out on send/recv operation";

TEST(Command, MessagesThatPassAreKnownFromThoseThatDoNot) {
  for (const char* passing :
       {kTimedOut, "slurm_load_jobs error: Unable to contact slurm controller (connect failure)",
        "sbatch: error: Slurm temporarily unable to accept job, sleeping and retrying",
        "slurm_load_jobs error: Zero Bytes were transmitted or received",
        "slurm_load_jobs error: Slurm backup controller in standby mode",
        "sbatch: error: connect: Connection refused"}) {
    EXPECT_TRUE(is_passing(passing)) << passing;
  }
  for (const char* lasting :
       {"sbatch: error: invalid partition specified: fast",
        "sbatch: error: Batch job submission failed: Requested node configuration is not available",
        "sbatch: error: Batch job submission failed: Invalid account or account/partition "
        "combination specified",
        "/usr/bin/env: 'sbatch': No such file or directory", ""}) {
    EXPECT_FALSE(is_passing(lasting)) << lasting;
  }
}

/// A program that fails so many times with this message, and then answers.
class Failing {
 public:
  Failing(int times, const std::string& message) {
    files::write_text(folder_ / "program", "echo call >> " + calls().string() + "\n[ $(wc -l < " +
                                               calls().string() + ") -gt " + std::to_string(times) +
                                               " ] && echo 7 && exit 0\necho \"" + message +
                                               "\" >&2\nexit 1\n");
  }
  std::string ask(std::size_t further_tries) const {
    const std::atomic<bool> stop{false};
    return patient_output({"sh", (folder_ / "program").string()}, folder_.path(),
                          Waits(further_tries, std::chrono::milliseconds(1)), stop);
  }
  std::size_t times_asked() const { return files::read_text(calls()).size() / 5; }

 private:
  std::filesystem::path calls() const { return folder_ / "calls"; }
  testing::TemporaryFolder folder_;
};

TEST(Command, IsTriedAgainWhereTheControllerWasBusy) {
  for (const int times : {0, 1, 3}) {
    const Failing program(times, kTimedOut);
    EXPECT_EQ(program.ask(5), "7\n");
    EXPECT_EQ(program.times_asked(), static_cast<std::size_t>(times) + 1);
  }
}

TEST(Command, IsGivenUpAfterTheLastTryAndSaysHowManyThereWere) {
  const Failing program(100, kTimedOut);
  try {
    program.ask(3);
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("Socket timed out"));
    EXPECT_THAT(error.what(), HasSubstr("4 tries"));
  }
  EXPECT_EQ(program.times_asked(), 4U);
}

TEST(Command, IsNotTriedAgainAfterAnErrorThatLasts) {
  const Failing program(1, "sbatch: error: invalid partition specified: fast");
  EXPECT_THROW(program.ask(5), std::runtime_error);
  EXPECT_EQ(program.times_asked(), 1U);
}

}  // namespace
}  // namespace traverse::batch
