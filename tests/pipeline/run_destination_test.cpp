#include "traverse/pipeline/run_destination.hpp"

#include <map>
#include <string>
#include <unistd.h>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/digest.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/files/work_folder.hpp"
#include "traverse/pipeline/run_record.hpp"

#include "run_replacement.hpp"
#include "temporary_folder.hpp"

namespace traverse::pipeline {
namespace {

namespace fs = std::filesystem;
using Outcome = RunDestination::Outcome;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::TemporaryFolder;
using ::testing::UnorderedElementsAre;

/// Writes what a run writes, as far as a folder is known by it. \param mark stands in each file
void write_run(const RunFolder& run, RunStatus status, const std::string& mark) {
  files::make_writable_folder(run.images());
  files::write_text(run.trajectory(), mark);
  files::write_text(run.map_points(), mark);
  files::write_text(run.report(), mark);
  files::write_text(run.images() / "map-height.png", mark);
  RunRecord record;
  record.status = status;
  write_record(run, record);
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

std::map<std::string, std::string> digests_below(const fs::path& folder) {
  std::map<std::string, std::string> digests;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    digests[fs::relative(entry.path(), folder).string()] = files::sha256_of_file(entry.path());
  }
  return digests;
}

class RunDestinationTest : public ::testing::Test {
 protected:
  /// Writes a run to `folder` as the program does. \returns where it stands
  fs::path made(const fs::path& folder, Outcome outcome, const std::string& mark,
                bool force = false) {
    RunDestination destination(folder, {});
    const RunFolder work = destination.begin();
    write_run(work, outcome == Outcome::kComplete ? RunStatus::kOk : RunStatus::kInterrupted, mark);
    return destination.finish(outcome, force).path;
  }
  std::string text(const std::string& file) const { return files::read_text(parent_ / file); }

  TemporaryFolder parent_;
  RunFolder run_{parent_ / "run"};
};

std::string refusal(const fs::path& folder, const std::vector<RunDestination::Input>& inputs = {}) {
  try {
    const RunDestination destination(folder, inputs);
  } catch (const files::OutputError& error) {
    return error.what();
  }
  return "";
}

TEST_F(RunDestinationTest, ARunStandsInItsPlaceOnlyWhenItIsComplete) {
  RunDestination destination(parent_ / "some/deep/run/", {});
  const RunFolder work = destination.begin();
  write_run(work, RunStatus::kOk, "new");
  EXPECT_FALSE(fs::exists(parent_ / "some/deep/run"));
  EXPECT_EQ(destination.finish(Outcome::kComplete, false).path, parent_ / "some/deep/run");
  EXPECT_EQ(text("some/deep/run/map.ply"), "new");
  EXPECT_THAT(names_in(parent_ / "some/deep"), ElementsAre("run"));
}

TEST_F(RunDestinationTest, NothingIsLeftOfARunThatGetsNoName) {
  {
    RunDestination destination(run_.path, {});
    write_run(destination.begin(), RunStatus::kOk, "new");
  }
  EXPECT_THAT(names_in(parent_.path()), ElementsAre());
}

TEST_F(RunDestinationTest, AnEarlierRunIsReplacedAndWhatIsNotItsOwnStays) {
  made(run_.path, Outcome::kComplete, "old");
  files::write_text(run_.loops(), "old");
  files::write_text(run_.path / ".map.ply.traverse-4711-0.partial", "of a killed run");
  files::write_text(run_.images() / ".map-height.png.4711.partial", "of a killed run");
  files::make_writable_folder(run_.path / "mine/deep/empty");
  files::make_writable_folder(run_.images() / "folder");
  std::map<std::string, std::string> foreign;
  for (const char* name :
       {"notes.txt", ".hidden", "map.ply.bak", "mine/deep/file", "images/mine.png",
        "images/map-height.txt", "images/folder/map-height.png"}) {
    files::write_text(run_.path / name, std::string("mine: ") + name);
    foreign[name] = files::sha256_of_file(run_.path / name);
  }
  fs::create_symlink("nowhere", run_.path / "link");

  EXPECT_EQ(made(run_.path, Outcome::kComplete, "new"), run_.path);
  for (const auto& [name, digest] : foreign) {
    EXPECT_EQ(files::sha256_of_file(run_.path / name), digest) << name;
  }
  EXPECT_TRUE(fs::is_directory(run_.path / "mine/deep/empty"));
  EXPECT_EQ(fs::read_symlink(run_.path / "link"), "nowhere");
  EXPECT_EQ(text("run/map.ply"), "new");
  EXPECT_EQ(text("run/images/map-height.png"), "new");
  EXPECT_FALSE(fs::exists(run_.loops())) << "results of two runs must not mix";
  EXPECT_THAT(names_in(run_.path),
              UnorderedElementsAre("run.json", "trajectory.tum", "map.ply", "report.html", "images",
                                   "notes.txt", ".hidden", "map.ply.bak", "mine", "link"));
  EXPECT_THAT(names_in(parent_.path()), ElementsAre("run"));
}

TEST_F(RunDestinationTest, AFolderThatIsNoRunIsRefusedAndNotTouched) {
  const fs::path folder = parent_ / "mine";
  files::make_writable_folder(folder / "images");
  for (const char* name : {"map.ply", "reference.tum", "images/holiday.png"}) {
    files::write_text(folder / name, name);
  }
  const auto before = digests_below(parent_.path());
  EXPECT_THAT(refusal(folder), AllOf(HasSubstr("not an earlier run"), HasSubstr("'map.ply'"),
                                     HasSubstr("no run.json of a run"), HasSubstr("-o")));
  EXPECT_EQ(digests_below(parent_.path()), before);
  for (const char* json : {"", "{}", "[1]", "{\"status\": \"ok\"}", "not JSON"}) {
    files::write_text(folder / "run.json", json);
    EXPECT_THAT(refusal(folder), HasSubstr("not an earlier run")) << json;
  }
}

TEST_F(RunDestinationTest, AFolderInThePlaceOfAFileOfARunIsRefused) {
  made(run_.path, Outcome::kComplete, "old");
  files::make_writable_folder(run_.path / "loops.csv");
  EXPECT_THAT(refusal(run_.path), HasSubstr("loops.csv in it is a folder"));
  fs::remove(run_.path / "loops.csv");
  fs::remove_all(run_.images());
  files::write_text(run_.images(), "");
  EXPECT_THAT(refusal(run_.path), HasSubstr("images in it is not a folder"));
}

TEST_F(RunDestinationTest, AFileAndALinkToNowhereAreRefused) {
  files::write_text(parent_ / "file", "");
  EXPECT_THAT(refusal(parent_ / "file"), HasSubstr("not a folder"));
  fs::create_symlink(parent_ / "nowhere", parent_ / "link");
  EXPECT_THAT(refusal(parent_ / "link"), HasSubstr("not there"));
}

TEST_F(RunDestinationTest, TheFolderOfWhatTheRunReadsIsRefused) {
  files::make_writable_folder(parent_ / "drive/velodyne");
  made(run_.path, Outcome::kComplete, "old");
  files::write_text(run_.path / "drive.rawlog", "");
  fs::create_directory_symlink(parent_ / "drive", parent_ / "link");
  for (const char* recording : {"drive", "drive/velodyne", "link"}) {
    EXPECT_THAT(refusal(parent_ / "drive", {{"the recording", parent_ / recording}}),
                AllOf(HasSubstr("the recording"), HasSubstr(recording)));
  }
  EXPECT_THAT(refusal(run_.path, {{"the recording", run_.path / "drive.rawlog"}}),
              HasSubstr("drive.rawlog"));
  EXPECT_THAT(refusal(run_.path, {{"the map", run_.path}}), HasSubstr("the map"));
  EXPECT_EQ(refusal(parent_ / "drive/run", {{"the recording", parent_ / "drive"}}), "");
  EXPECT_EQ(refusal(parent_ / "driven", {{"the recording", parent_ / "drive"}}), "");
}

TEST_F(RunDestinationTest, APartialRunStandsBesideAnEarlierOne) {
  EXPECT_EQ(made(run_.path, Outcome::kPartial, "first"), run_.path);
  EXPECT_EQ(made(run_.path, Outcome::kPartial, "second"), parent_ / "run.interrupted");
  EXPECT_EQ(made(run_.path, Outcome::kPartial, "third"), parent_ / "run.interrupted");
  EXPECT_EQ(text("run/map.ply"), "first");
  EXPECT_EQ(text("run.interrupted/map.ply"), "third");
  EXPECT_EQ(made(run_.path, Outcome::kComplete, "fourth"), run_.path);
  EXPECT_EQ(text("run.interrupted/map.ply"), "third");
  EXPECT_EQ(made(run_.path, Outcome::kPartial, "fifth", /*force=*/true), run_.path);
  EXPECT_EQ(text("run/map.ply"), "fifth");
  EXPECT_THAT(names_in(parent_.path()), UnorderedElementsAre("run", "run.interrupted"));
}

TEST_F(RunDestinationTest, WhatStandsBesideIsNotReplacedIfItIsSomethingElse) {
  made(run_.path, Outcome::kComplete, "old");
  files::make_writable_folder(parent_ / "run.interrupted");
  files::write_text(parent_ / "run.interrupted/notes.txt", "mine");
  made(parent_ / "run.interrupted.2", Outcome::kComplete, "complete");
  EXPECT_EQ(made(run_.path, Outcome::kPartial, "new"), parent_ / "run.interrupted.3");
  EXPECT_EQ(text("run.interrupted/notes.txt"), "mine");
  EXPECT_EQ(text("run.interrupted.2/map.ply"), "complete");
}

TEST_F(RunDestinationTest, ARunWithoutAPoseIsReplacedByAnything) {
  files::make_writable_folder(run_.path);
  write_record(run_, {});
  files::write_text(run_.path / "notes.txt", "mine");
  EXPECT_EQ(made(run_.path, Outcome::kPartial, "new"), run_.path);
  EXPECT_EQ(text("run/notes.txt"), "mine");
}

TEST_F(RunDestinationTest, ASecondRunIntoOneFolderIsRefused) {
  RunDestination first(run_.path, {});
  const RunFolder work = first.begin();
  write_run(work, RunStatus::kOk, "first");
  try {
    RunDestination(run_.path, {}).begin();
    FAIL();
  } catch (const files::FolderInUse& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr(run_.path.string()),
                                    HasSubstr("process " + std::to_string(::getpid()))));
  }
  first.finish(Outcome::kComplete, false);
  EXPECT_EQ(text("run/map.ply"), "first");
  EXPECT_EQ(made(run_.path, Outcome::kComplete, "second"), run_.path);
}

TEST_F(RunDestinationTest, WhatAKilledRunLeftIsClearedByTheNext) {
  const fs::path work = parent_ / ".run.traverse-work";
  files::make_writable_folder(work / "run");
  files::write_text(work / "run/loops.csv", "half");
  files::write_text(work / "lock", "process 1 on mars");
  fs::permissions(work / "run", fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(made(run_.path, Outcome::kComplete, "new"), run_.path);
  EXPECT_FALSE(fs::exists(run_.loops()));
  EXPECT_THAT(names_in(parent_.path()), ElementsAre("run"));
}

TEST_F(RunDestinationTest, ALinkToAFolderStaysALink) {
  files::make_writable_folder(parent_ / "elsewhere");
  fs::create_directory_symlink(parent_ / "elsewhere", parent_ / "run");
  for (const char* mark : {"one", "two"}) {
    EXPECT_EQ(made(run_.path, Outcome::kComplete, mark), run_.path);
    EXPECT_TRUE(fs::is_symlink(run_.path));
    EXPECT_EQ(text("elsewhere/map.ply"), mark);
  }
}

TEST_F(RunDestinationTest, WhatTheUserPutThereMeanwhileIsNotWrittenOver) {
  RunDestination destination(run_.path, {});
  write_run(destination.begin(), RunStatus::kOk, "new");
  files::make_writable_folder(run_.path);
  files::write_text(run_.path / "notes.txt", "mine");
  EXPECT_EQ(destination.finish(Outcome::kComplete, false).path, parent_ / "run.interrupted");
  EXPECT_EQ(text("run.interrupted/map.ply"), "new");
  EXPECT_THAT(names_in(run_.path), ElementsAre("notes.txt"));
}

TEST_F(RunDestinationTest, MessagesNameThePlaceAndNotTheWorkFolder) {
  RunDestination destination(run_.path, {});
  const std::string file = destination.begin().map_points().string();
  EXPECT_EQ(destination.in_words(file + " and " + file, "R"), "R/map.ply and R/map.ply");
}

/// File systems without an exchange of two names.
class ReplacementByTwoRenames : public RunDestinationTest {
 protected:
  ReplacementByTwoRenames() {
    write_run(run_, RunStatus::kOk, "old");
    files::write_text(run_.path / "notes.txt", "mine");
    files::make_writable_folder(made_.parent_path());
    write_run(RunFolder{made_}, RunStatus::kOk, "new");
  }
  const fs::path made_ = parent_ / ".run.traverse-work/run";
  const fs::path aside_ = parent_ / ".run.traverse-work/earlier";
};

TEST_F(ReplacementByTwoRenames, GivesTheSame) {
  replace_run(made_, run_.path, aside_, Exchange::kByTwoRenames);
  EXPECT_EQ(text("run/map.ply"), "new");
  EXPECT_EQ(text("run/notes.txt"), "mine");
  EXPECT_THAT(names_in(parent_ / ".run.traverse-work"), ElementsAre());
}

TEST_F(ReplacementByTwoRenames, KilledBetweenThemTheNextRunCompletesIt) {
  fs::rename(run_.path, aside_);  // and killed here
  RunDestination destination(run_.path, {});
  destination.begin();
  EXPECT_EQ(text("run/map.ply"), "new");
  EXPECT_EQ(text("run/notes.txt"), "mine");
  EXPECT_FALSE(fs::exists(aside_));
}

TEST_F(ReplacementByTwoRenames, KilledAfterThemTheNextRunRemovesTheEarlierOne) {
  fs::rename(run_.path, aside_);
  fs::rename(made_, run_.path);
  RunDestination(run_.path, {}).begin();
  EXPECT_EQ(text("run/map.ply"), "new");
  EXPECT_EQ(text("run/notes.txt"), "mine");
  EXPECT_FALSE(fs::exists(aside_));
}

}  // namespace
}  // namespace traverse::pipeline
