#include "traverse/batch/completion.hpp"

#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "temporary_folder.hpp"

namespace traverse::batch {
namespace {

using testing::TemporaryFolder;

Completion made() {
  Completion completion;
  completion.id = "0123";
  completion.identity = "program 1\n";
  completion.outcome = Outcome::kCrashed;
  completion.reason = "signal 11";
  completion.signal = 11;
  completion.wall_s = 1.25;
  completion.limits = {10, 500, 2, 3};
  completion.metrics = {{"mme", -1.5}, {"wall_s", 1.25}};
  completion.last_lines = {"floam: 3 frames", "bytes \xff that are no text"};
  return completion;
}

TEST(Completion, ReadsBack) {
  const TemporaryFolder folder;
  files::write_text(folder / "result.json", to_json(made()));
  const Completion read = read_completion(folder / "result.json");
  EXPECT_EQ(read.outcome, Outcome::kCrashed);
  EXPECT_EQ(read.metrics, made().metrics);
  EXPECT_EQ(read.limits, made().limits);
  EXPECT_EQ(read.signal, 11);
  EXPECT_EQ(read.last_lines[0], "floam: 3 frames");
}

TEST(Completion, ARecordThatIsNotWholeIsNone) {
  const TemporaryFolder folder;
  const std::string text = to_json(made());
  for (const std::size_t length : {std::size_t{0}, std::size_t{10}, text.size() - 3}) {
    files::write_text(folder / "result.json", text.substr(0, length));
    EXPECT_FALSE(find_completion(folder / "result.json")) << length;
    EXPECT_THROW(read_completion(folder / "result.json"), files::InputError);
  }
  EXPECT_FALSE(find_completion(folder / "none.json"));
}

TEST(Completion, OnlyARunThatALimitEndedIsOutdatedByAnother) {
  Job job;
  job.limits = {20, 500, 2, 3};
  Completion completion = made();
  const auto outdated_as = [&](Outcome outcome) {
    completion.outcome = outcome;
    return is_outdated(completion, job);
  };
  EXPECT_TRUE(outdated_as(Outcome::kTimedOut));
  EXPECT_FALSE(outdated_as(Outcome::kOutOfMemory));
  EXPECT_FALSE(outdated_as(Outcome::kOk));
  EXPECT_FALSE(outdated_as(Outcome::kCrashed));
  job.limits = {10, 600, 2, 3};
  EXPECT_FALSE(outdated_as(Outcome::kTimedOut));
  EXPECT_TRUE(outdated_as(Outcome::kOutOfMemory));
}

}  // namespace
}  // namespace traverse::batch
