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

TEST(AtomicFile, ReplacesWhatALinkLeadsToAndNotTheLink) {
  const TemporaryFolder folder;
  write_text(folder / "a.txt", "old");
  std::filesystem::create_symlink("a.txt", folder / "link");
  write_text(folder / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(read_text(folder / "a.txt"), "new");
}

TEST(AtomicFile, ADeviceIsWrittenToAndStaysADevice) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/full", folder / "full");
  EXPECT_THROW(write_text(folder / "full", "text"), OutputError);
  std::filesystem::create_symlink("/dev/null", folder / "null");
  write_text(folder / "null", "text");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  EXPECT_EQ(files_in(folder.path()), 2U);
}

TEST(AtomicFiles, NoneAppearsBeforeAllAreWhole) {
  const TemporaryFolder folder;
  write_text(folder / "a.txt", "old");
  {
    AtomicFiles files;
    files.write(folder / "a.txt", "new");
    files.write(folder / "b.txt", "new");
    EXPECT_EQ(read_text(folder / "a.txt"), "old");
    EXPECT_FALSE(std::filesystem::exists(folder / "b.txt"));
    files.commit();
  }
  EXPECT_EQ(read_text(folder / "a.txt"), "new");
  EXPECT_EQ(read_text(folder / "b.txt"), "new");
  {
    AtomicFiles files;
    files.write(folder / "a.txt", "newer");
    AtomicFile& large = files.add(folder / "b.txt");
    const FileSizeLimit limit(1000);
    large.stream() << std::string(1 << 20, 'x');
    EXPECT_THROW(files.commit(), OutputError);
  }
  EXPECT_EQ(read_text(folder / "a.txt"), "new");
  EXPECT_EQ(files_in(folder.path()), 2U);
}

TEST(AtomicFolder, ReplacesAnEarlierResultByOneStep) {
  const TemporaryFolder folder;
  const auto place = folder / "out";
  std::filesystem::create_directory(place);
  write_text(place / "a.txt", "old");
  write_text(place / "b.txt", "old");
  { write_text(AtomicFolder(place, {"a.txt", "b.txt"}).temporary_path() / "a.txt", "half"); }
  EXPECT_EQ(read_text(place / "a.txt"), "old");
  AtomicFolder output(place, {"a.txt", "b.txt"});
  write_text(output.temporary_path() / "a.txt", "new");
  EXPECT_EQ(read_text(place / "a.txt"), "old");
  output.commit();
  EXPECT_EQ(read_text(place / "a.txt"), "new");
  EXPECT_EQ(files_in(place), 1U);
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFolder, KeepsWhatCameIntoTheFolderMeanwhile) {
  const TemporaryFolder folder;
  const auto place = folder / "out";
  std::filesystem::create_directory(place);
  write_text(place / "a.txt", "old");
  AtomicFolder output(place, {"a.txt"});
  write_text(output.temporary_path() / "a.txt", "new");
  write_text(output.temporary_path() / "b.txt", "new");
  write_text(place / "notes.txt", "foreign");
  write_text(place / "b.txt", "foreign");
  output.commit();
  EXPECT_EQ(read_text(place / "a.txt"), "new");
  EXPECT_EQ(read_text(place / "b.txt"), "new");
  EXPECT_EQ(read_text(place / "b.txt.earlier"), "foreign");
  EXPECT_EQ(read_text(place / "notes.txt"), "foreign");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFolder, ALinkToAnEmptyFolderIsThatFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "real");
  std::filesystem::create_directory_symlink("real", folder / "link");
  AtomicFolder output(folder / "link");
  write_text(output.temporary_path() / "a.txt", "whole");
  output.commit();
  EXPECT_EQ(read_text(folder / "real/a.txt"), "whole");
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
