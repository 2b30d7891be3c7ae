#include "traverse/files/unfinished.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"

#include "temporary_folder.hpp"

namespace traverse::files {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using testing::TemporaryFolder;

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

/// Runs `work` in a process of its own. \returns its status, as waitpid gives it.
template <typename Work>
int in_another_process(const Work& work) {
  const pid_t pid = ::fork();
  if (pid == 0) {
    work();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(pid, &status, 0);
  return status;
}

/// A program in the middle of a file and a folder.
void work_in(const fs::path& folder) {
  static AtomicFile file(folder / "a.txt");
  static AtomicFolder made(folder / "out");
  file.stream() << "half";
  write_text(made.temporary_path() / "b.txt", "whole");
  fs::create_directory(made.temporary_path() / "deep");
  write_text(made.temporary_path() / "deep/c.txt", "whole");
}

TEST(Unfinished, IsRemovedWithFoldersAndNothingElse) {
  const TemporaryFolder folder;
  write_text(folder / "foreign.txt", "");
  in_another_process([&] {
    work_in(folder.path());
    if (names_in(folder.path()).size() != 3) ::_exit(1);
    remove_unfinished();
    ::_exit(0);  // the other thread's objects would wait for ever
  });
  EXPECT_THAT(names_in(folder.path()), ElementsAre("foreign.txt"));
}

TEST(Unfinished, FinishedFilesStay) {
  const TemporaryFolder folder;
  in_another_process([&] {
    write_text(folder / "a.txt", "whole");
    AtomicFolder(folder / "out").commit();
    remove_unfinished();
    ::_exit(0);
  });
  EXPECT_THAT(names_in(folder.path()), ElementsAre("a.txt", "out"));
}

TEST(Unfinished, WhatAKilledProgramLeftGoesWithTheNextFileInTheFolder) {
  const TemporaryFolder folder;
  const int status = in_another_process([&] {
    work_in(folder.path());
    ::raise(SIGKILL);
  });
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_EQ(names_in(folder.path()).size(), 2U);
  write_text(folder / "new.txt", "");
  EXPECT_THAT(names_in(folder.path()), ElementsAre("new.txt"));
}

TEST(Unfinished, WhatALivingProgramWritesStays) {
  const TemporaryFolder folder;
  AtomicFile living(folder / "a.txt");
  AtomicFolder living_folder(folder / "out");
  living.stream() << "whole";
  const fs::path again = folder / "again";
  fs::create_directory_symlink(folder.path(), again);  // a place that was not looked at yet
  const int status = in_another_process([&] {
    write_text(again / "another.txt", "");
    ::_exit(fs::exists(again / "another.txt") ? 0 : 1);
  });
  EXPECT_EQ(status, 0);
  living.commit();
  living_folder.commit();
  EXPECT_EQ(read_text(folder / "a.txt"), "whole");
  EXPECT_THAT(names_in(folder.path()), ElementsAre("a.txt", "again", "another.txt", "out"));
}

TEST(Unfinished, NamesThatAreNotOursStay) {
  const TemporaryFolder folder;
  const std::set<std::string> foreign{".a.partial",
                                      ".a.4711.partial",
                                      ".a.traverse-4711.partial",
                                      "a.traverse-1-2.partial",
                                      ".a.traverse-1-2.partial.txt",
                                      ".a.traverse-x-2.partial",
                                      ".a.traverse-1-.partial",
                                      ".traverse-1-2.partial",
                                      ".a.Traverse-1-2.partial"};
  for (const std::string& name : foreign) std::ofstream(folder / name) << "foreign";
  std::ofstream(folder / ".a.traverse-1-2.partial") << "ours, of a dead program";
  write_text(folder / "new.txt", "");
  std::set<std::string> left = names_in(folder.path());
  EXPECT_EQ(left.erase("new.txt"), 1U);
  EXPECT_EQ(left, foreign);
}

TEST(Unfinished, ALinkOfSuchANameIsNotFollowed) {
  const TemporaryFolder folder;
  const TemporaryFolder elsewhere;
  write_text(elsewhere / "foreign.txt", "");
  fs::create_directory_symlink(elsewhere.path(), folder / ".a.traverse-1-2.partial");
  write_text(folder / "new.txt", "");
  EXPECT_THAT(names_in(elsewhere.path()), ElementsAre("foreign.txt"));
}

}  // namespace
}  // namespace traverse::files
