#include "traverse/pipeline/run_folder.hpp"

#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

#include "temporary_folder.hpp"

namespace traverse::pipeline {
namespace {

using testing::TemporaryFolder;

TEST(RunFolder, PreparingRemovesAnOldRunAndNothingElse) {
  const TemporaryFolder parent;
  const RunFolder folder{parent / "run"};
  folder.prepare();
  files::write_text(folder.record(), "{}");
  files::make_writable_folder(folder.images());
  files::write_text(folder.images() / "old.png", "");
  files::write_text(folder.path / "notes.txt", "mine");
  folder.prepare();
  EXPECT_FALSE(std::filesystem::exists(folder.record()));
  EXPECT_FALSE(std::filesystem::exists(folder.images()));
  EXPECT_TRUE(std::filesystem::exists(folder.path / "notes.txt"));
}

TEST(RunFolder, AFileInTheWayIsAnError) {
  const TemporaryFolder parent;
  files::write_text(parent / "run", "");
  EXPECT_THROW(RunFolder{parent / "run"}.prepare(), files::OutputError);
}

}  // namespace
}  // namespace traverse::pipeline
