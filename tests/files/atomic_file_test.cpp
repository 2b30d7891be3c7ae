#include "traverse/files/atomic_file.hpp"

#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "file_size_limit.hpp"
#include "temporary_folder.hpp"

namespace traverse::files {
namespace {

using testing::FileSizeLimit;
using testing::TemporaryFolder;

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(AtomicFile, AppearsOnlyAtCommit) {
  const TemporaryFolder folder;
  AtomicFile file(folder / "a.txt");
  file.stream() << "whole";
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
  file.commit();
  EXPECT_EQ(read_text(folder / "a.txt"), "whole");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFile, WithoutCommitTheOldFileStaysAndNothingIsLeft) {
  const TemporaryFolder folder;
  write_text(folder / "a.txt", "old");
  { AtomicFile(folder / "a.txt").stream() << "half"; }
  EXPECT_EQ(read_text(folder / "a.txt"), "old");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFile, SaysWhyAFolderCannotBeWritten) {
  const TemporaryFolder folder;
  try {
    AtomicFile file(folder / "missing" / "a.txt");
    FAIL() << "no error";
  } catch (const OutputError& error) {
    EXPECT_NE(std::string(error.what()).find("No such file or directory"), std::string::npos);
  }
}

TEST(AtomicFile, AFullDiskIsAnErrorAndLeavesNothing) {
  const TemporaryFolder folder;
  {
    const FileSizeLimit limit(1000);
    EXPECT_THROW(write_text(folder / "a.txt", std::string(1 << 20, 'x')), OutputError);
  }
  EXPECT_EQ(files_in(folder.path()), 0U);
}

TEST(AtomicFolder, AppearsWholeAtCommit) {
  const TemporaryFolder folder;
  AtomicFolder output(folder / "out/");
  write_text(output.temporary_path() / "a.txt", "whole");
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  output.commit();
  EXPECT_EQ(read_text(folder / "out/a.txt"), "whole");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFolder, WithoutCommitNothingIsLeft) {
  const TemporaryFolder folder;
  { write_text(AtomicFolder(folder / "out").temporary_path() / "a.txt", "half"); }
  EXPECT_EQ(files_in(folder.path()), 0U);
}

TEST(AtomicFolder, ReplacesAnEmptyFolderButNothingElse) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "empty");
  AtomicFolder(folder / "empty").commit();
  EXPECT_TRUE(std::filesystem::is_directory(folder / "empty"));
  write_text(folder / "empty/a.txt", "");
  EXPECT_THROW(AtomicFolder{folder / "empty"}, OutputError);
  EXPECT_THROW(AtomicFolder{folder / "empty/a.txt"}, OutputError);
  EXPECT_THROW(AtomicFolder{folder / "missing/out"}, OutputError);
}

TEST(MakeWritableFolder, MakesParentsAndRefusesAFileInTheWay) {
  const TemporaryFolder folder;
  make_writable_folder(folder / "a/b/c");
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b/c"));
  EXPECT_EQ(files_in(folder / "a/b/c"), 0U);
  write_text(folder / "file", "");
  EXPECT_THROW(make_writable_folder(folder / "file"), OutputError);
  EXPECT_THROW(make_writable_folder(folder / "file/below"), OutputError);
}

}  // namespace
}  // namespace traverse::files
