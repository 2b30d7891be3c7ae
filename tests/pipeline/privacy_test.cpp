#include "traverse/pipeline/privacy.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/files/atomic_file.hpp"
#include "traverse/pipeline/provenance.hpp"
#include "traverse/pipeline/run_record.hpp"

#include "temporary_folder.hpp"

namespace traverse::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A user of this machine, whose home is below /home.
class PrivacyOfAUser : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const char* home = std::getenv("HOME")) home_ = home;
    ::setenv("HOME", "/home/alice", 1);
  }
  void TearDown() override { ::setenv("HOME", home_.c_str(), 1); }

  std::string home_ = "/";
};

TEST_F(PrivacyOfAUser, TellsPathsFromTheRun) {
  const Privacy privacy("/home/alice/work/runs/first");
  EXPECT_EQ(privacy.path("/home/alice/work/drive.rawlog"), "../../drive.rawlog");
  EXPECT_EQ(privacy.path("/home/alice/data/drive/"), "../../../data/drive");
  EXPECT_EQ(privacy.path("/home/alice/work/runs/first"), ".");
  EXPECT_EQ(privacy.path("drive.rawlog"), "drive.rawlog");
}

TEST_F(PrivacyOfAUser, TellsTheNameAloneOfWhatIsElsewhere) {
  const Privacy privacy("/home/alice/work/first");
  EXPECT_EQ(privacy.path("/home/bob/drive.rawlog"), "drive.rawlog") << "above the home";
  EXPECT_EQ(privacy.path("/data/drive.rawlog"), "drive.rawlog") << "through the root";
  EXPECT_EQ(Privacy("/data/alice/run").path("/data/alice/drives/d.rawlog"), "../drives/d.rawlog");
  EXPECT_EQ(Privacy("/data/runs/run").path("/data/alice/d.rawlog"), "d.rawlog")
      << "the user's name";
}

TEST_F(PrivacyOfAUser, FindsPathsInTexts) {
  const Privacy privacy("/home/alice/work/first");
  EXPECT_EQ(privacy.text("poses of '/home/alice/work/gt.tum', line 3"),
            "poses of '../gt.tum', line 3");
  EXPECT_EQ(privacy.text("--recording reference.file=/tmp/x/gt.tum"),
            "--recording reference.file=gt.tum");
  EXPECT_EQ(privacy.text("(/usr/bin/traverse; /var/a:12)"), "(traverse; a:12)");
  EXPECT_EQ(privacy.text("in $HOME=/home/alice"), "in $HOME=../..");
  for (const char* other : {"2.5 m/s", "least / median / most", "1/2", "/points of a topic", "/",
                            "https://example.org/home", "3 // 4", ""}) {
    EXPECT_EQ(privacy.text(other), other);
  }
}

TEST_F(PrivacyOfAUser, APathWithBlanksThatIsThereIsOnePath) {
  const testing::TemporaryFolder folder;
  files::write_text(folder / "my drive.rawlog", "");
  const Privacy privacy(folder / "run");
  EXPECT_EQ(privacy.text((folder / "my drive.rawlog").string()), "../my drive.rawlog");
}

TEST_F(PrivacyOfAUser, LinksOnTheWayDoNotMatter) {
  const testing::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "real");
  std::filesystem::create_directory_symlink(folder / "real", folder / "link");
  files::write_text(folder / "real/drive.rawlog", "");
  EXPECT_EQ(Privacy(folder / "link/run").path(folder / "real/drive.rawlog"), "../drive.rawlog");
}

TEST_F(PrivacyOfAUser, ARecordTellsNothingOfTheMachine) {
  RunRecord record;
  record.place = "/home/alice/work/run";
  record.recording.path = "/home/alice/work/drive.rawlog";
  record.recording.facts.push_back(
      {"reference", "/srv/alice/gt.tum", "/home/alice/.config/a.yaml"});
  record.command = {"/home/alice/bin/traverse", "run", "drive.rawlog", "--reference",
                    "/srv/alice/gt.tum"};
  record.reference_file = "/srv/alice/gt.tum";
  record.skipped.add("no file /home/alice/x", "/home/alice/y");
  record.files.push_back({"trajectory.tum", 3, "abc"});
  const HostInfo host = host_info();
  const std::string json = Privacy(record.place).record(to_json(record, build_info(), host));
  for (const std::string& told :
       {std::string("/home"), std::string("alice"), std::string("/srv"), host.name, host.cpu}) {
    EXPECT_THAT(json, Not(HasSubstr("\"" + told))) << told;
    EXPECT_THAT(json, Not(HasSubstr("/" + told))) << told;
  }
  const auto parsed = nlohmann::json::parse(json);
  EXPECT_EQ(parsed["recording"]["path"], "../drive.rawlog");
  EXPECT_EQ(parsed["recording"]["path_from_run"], "../drive.rawlog");
  EXPECT_EQ(parsed["reference"]["file"], "gt.tum");
  EXPECT_EQ(parsed["command"][0], "../../bin/traverse");
  EXPECT_EQ(parsed["files"]["trajectory.tum"]["bytes"], 3);
  EXPECT_EQ(parsed["private"], true);
  EXPECT_EQ(parsed["host"]["logical_cpus"], host.logical_cpus);

  record.recording.path = "/srv/alice/drive.rawlog";
  const auto elsewhere =
      nlohmann::json::parse(Privacy(record.place).record(to_json(record, build_info(), host)));
  EXPECT_EQ(elsewhere["recording"]["path"], "drive.rawlog");
  EXPECT_TRUE(elsewhere["recording"]["path_from_run"].is_null());
}

}  // namespace
}  // namespace traverse::pipeline
