#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"

#include "end_to_end/program.hpp"
#include "temporary_folder.hpp"
#include "test_data.hpp"

namespace traverse {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::ProgramResult;
using testing::run_program;
using testing::TemporaryFolder;

/// A simulated stretch of street and a run of it, made once for all tests of the suite.
class RunCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    const ProgramResult simulated =
        run_program("simulate town_short --first 80 --duration 1.3 -o " + file("street.rawlog"));
    ASSERT_EQ(simulated.status, 0) << simulated.messages;
    result_ = new ProgramResult(run_program("run " + recording() + " -o " + file("run")));
  }
  static void TearDownTestSuite() {
    delete result_;
    delete folder_;
  }

  static std::string file(const std::string& name) { return (*folder_ / name).string(); }
  static std::string recording() { return file("street.rawlog"); }
  static json record(const std::string& run) {
    return json::parse(files::read_text(*folder_ / run / "run.json"));
  }

  static inline TemporaryFolder* folder_ = nullptr;
  static inline ProgramResult* result_ = nullptr;
};

TEST_F(RunCommand, GoesFromARecordingToAReport) {
  EXPECT_EQ(result_->status, 0) << result_->messages;
  EXPECT_THAT(result_->output,
              AllOf(HasSubstr("13 estimated, 12 of 12 registered, no record skipped"),
                    ContainsRegex("APE 0\\.0[0-9]+ m"), HasSubstr("report.html")));
  for (const char* name :
       {"run.json", "trajectory.tum", "reference.tum", "frames.csv", "map.ply", "map.simplemap",
        "scan.ply", "evaluation.json", "report.html", "images/trajectory-above.png",
        "images/trajectory-error.png", "images/map-height.png", "images/scan-features.png"}) {
    EXPECT_TRUE(fs::is_regular_file(*folder_ / "run" / name)) << name;
  }
  EXPECT_EQ(record("run")["status"], "ok");
  EXPECT_EQ(record("run")["frames"]["used"], 13);
}

TEST_F(RunCommand, TheReportShowsNoErrorInABrowser) {
  if (std::system("command -v chromium-headless-shell > /dev/null") != 0) {
    GTEST_SKIP() << "chromium-headless-shell is not installed";
  }
  // Without WebGL, about whose software the browser itself would log; tests/browser has it.
  const std::string command =
      "chromium-headless-shell --no-sandbox --disable-3d-apis --enable-logging=stderr --v=0 "
      "--user-data-dir=" +
      file("browser") + " --virtual-time-budget=5000 --dump-dom file://" + file("run/report.html") +
      " > " + file("dom.html") + " 2> " + file("browser.log");
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_THAT(files::read_text(file("browser.log")), Not(HasSubstr("CONSOLE")));
  EXPECT_THAT(files::read_text(file("dom.html")), HasSubstr("<h1>APE "));
}

TEST_F(RunCommand, TheSameRunGivesTheSameBytesForAnyNumberOfThreads) {
  for (const char* threads : {"1", "3"}) {
    const std::string again = file(std::string("again") + threads);
    const ProgramResult result =
        run_program("run " + recording() + " -o " + again + " --no-report --threads " + threads);
    ASSERT_EQ(result.status, 0) << result.messages;
    EXPECT_EQ(files::read_text(again + "/trajectory.tum"),
              files::read_text(file("run/trajectory.tum")))
        << threads;
    EXPECT_EQ(files::read_text(again + "/map.ply"), files::read_text(file("run/map.ply")));
    EXPECT_FALSE(fs::exists(again + "/report.html"));
  }
}

TEST_F(RunCommand, EvaluateRedoesTheRunsFigures) {
  const ProgramResult result =
      run_program("evaluate " + file("run") + " --align se3 --json " + file("again.json"));
  ASSERT_EQ(result.status, 0) << result.messages;
  const json again = json::parse(files::read_text(file("again.json")));
  const json first = json::parse(files::read_text(file("run/evaluation.json")));
  EXPECT_NEAR(again["ape"]["translation"]["rmse"], first["ape"]["translation"]["rmse"], 1e-12);
  EXPECT_EQ(again["association"]["pairs"], 13);
}

TEST_F(RunCommand, TheReportCanBeMadeAgainFromTheFolder) {
  fs::copy(file("run"), file("copy"), fs::copy_options::recursive);
  // The commands that open a frame in a replay name the folder.
  const std::string before =
      std::regex_replace(files::read_text(file("copy/report.html")),
                         std::regex(file("run") + " --at"), file("copy") + " --at");
  fs::remove(file("copy/report.html"));
  fs::remove_all(file("copy/images"));
  ASSERT_EQ(run_program("report " + file("copy")).status, 0);
  EXPECT_EQ(files::read_text(file("copy/report.html")), before);
}

TEST_F(RunCommand, SettingsAndRangesAreKept) {
  const ProgramResult result = run_program(
      "run " + recording() + " -o " + file("part") +
      " --pipeline floam --first 2 --last 7 --set map.radius_m=60 --no-report --no-hash "
      "--set solver.huber_m=0.2");
  ASSERT_EQ(result.status, 0) << result.messages;
  const json part = record("part");
  EXPECT_EQ(part["frames"]["used"], 6);
  EXPECT_EQ(part["frames"]["first"], 2);
  EXPECT_TRUE(part["recording"]["sha256"].is_null());
  for (const json& setting : part["configuration"]["settings"]) {
    EXPECT_EQ(setting["changed"].get<bool>(),
              setting["key"] == "map.radius_m" || setting["key"] == "solver.huber_m");
  }
}

TEST_F(RunCommand, AReferenceFromElsewhereIsUsedAndOneThatDoesNotOverlapIsAnError) {
  auto truth = dataset::read_trajectory(file("run/reference.tum"), dataset::TrajectoryFormat::kTum);
  geometry::Trajectory late;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    late.push_back(geometry::shifted(truth.stamp(i), 1e6), truth.pose(i));
  }
  dataset::write_tum(file("late, and #odd.tum"), late);  // a name that YAML would read otherwise
  const ProgramResult result =
      run_program("run " + recording() + " -o " + file("late") + " --no-report --reference '" +
                  file("late, and #odd.tum") + "'");
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.messages, AllOf(HasSubstr("could not be compared"), HasSubstr("#odd.tum")));
  EXPECT_TRUE(fs::exists(file("late/trajectory.tum")));
  EXPECT_FALSE(record("late")["evaluation_error"].is_null());
}

TEST_F(RunCommand, WrongUsageIsTwoAndAFailureIsOne) {
  const auto status = [](const std::string& arguments) { return run_program(arguments).status; };
  EXPECT_EQ(status("run " + recording()), 2);  // no -o
  EXPECT_EQ(status("run " + recording() + " -o x --pipeline none"), 2);
  EXPECT_EQ(status("run " + recording() + " -o x --set solver.none=1"), 2);
  EXPECT_EQ(status("run " + recording() + " -o x --first 5 --last 4"), 2);
  EXPECT_EQ(status("fly"), 2);
  EXPECT_EQ(status("run " + file("nothing") + " -o " + file("x")), 1);
  EXPECT_EQ(status("--help"), 0);
  EXPECT_EQ(status("run --help"), 0);
}

TEST_F(RunCommand, AnOutputThatCannotBeWrittenIsToldAtOnce) {
  files::write_text(file("in-the-way"), "");
  const ProgramResult result = run_program("run " + recording() + " -o " + file("in-the-way"));
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.messages, HasSubstr("cannot be written"));
}

TEST_F(RunCommand, AFullDiskEndsWithAnErrorAndNothingHalfWritten) {
  // ulimit -f stands for the full disk: no file may grow beyond 60 kB (dash counts 512 bytes), so
  // that run.json has room and the map has not.
  const std::string command = "sh -c \"ulimit -f 120; trap '' XFSZ; '" +
                              std::string(TRAVERSE_PROGRAM) + "' run " + recording() + " -o " +
                              file("full") + "\" 2> " + file("full.log") + " > /dev/null";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_THAT(files::read_text(file("full.log")), HasSubstr("cannot be written"));
  for (const auto& entry : fs::directory_iterator(file("full"))) {
    EXPECT_THAT(entry.path().filename().string(), Not(HasSubstr("partial")));
  }
  EXPECT_EQ(record("full")["status"], "failed");
}

TEST_F(RunCommand, ALogGetsPlainLines) {
  EXPECT_THAT(result_->messages, AllOf(HasSubstr("traverse: 13 frames"), Not(HasSubstr("\r"))));
}

TEST_F(RunCommand, ATunnelIsReportedAsDegenerate) {
  ASSERT_EQ(
      run_program("simulate tunnel --first 200 --duration 1.1 -o " + file("tunnel.rawlog")).status,
      0);
  const ProgramResult result =
      run_program("run " + file("tunnel.rawlog") + " -o " + file("tunnel"));
  ASSERT_EQ(result.status, 1) << result.messages;  // nothing tells how far it went
  EXPECT_THAT(
      files::read_text(file("tunnel/report.html")),
      ContainsRegex("Lost:</strong> [0-9]+ of 10 registered frames .* follow no measurement"));
}

// Accuracy is the same in every build; a sanitizer has seen all there is after a few frames.
#ifdef TRAVERSE_SANITIZED
constexpr std::size_t kMostFrames = 30;
#else
constexpr std::size_t kMostFrames = 1000;
#endif

TEST(RunOnKitti, BothDrivesReachTheAccuracyOfThePublishedSystemAndMore) {
  struct Case {
    const char* drive;
    const char* reference;
    std::size_t frames;
    double ape_m;
    double end_percent;
  };
  for (const Case& c : {Case{"2011_09_26_drive_0001", "poses_velo.txt", 108, 0.10, 0.6},
                        Case{"2011_09_26_drive_0005", "poses_velo_velint.txt", 100, 0.13, 1.6}}) {
    const fs::path drive = testing::kitti_drive(c.drive);
    if (!fs::is_directory(drive)) GTEST_SKIP() << testing::kNoDrives;
    const TemporaryFolder folder;
    const std::size_t frames = std::min(c.frames, kMostFrames);
    const ProgramResult result = run_program(
        "run --last " + std::to_string(frames - 1) + " " + drive.string() + " -o " +
        (folder / "run").string() + " --recording-config " + TRAVERSE_SHARE_DIR +
        "/recordings/kitti_raw_drive.yaml --reference " + (drive / c.reference).string() +
        " --reference-frame lidar --no-report --no-hash");
    ASSERT_EQ(result.status, 0) << result.messages;
    const json evaluation = json::parse(files::read_text(folder / "run/evaluation.json"));
    EXPECT_EQ(evaluation["association"]["pairs"], frames);
    EXPECT_LT(evaluation["ape"]["translation"]["rmse"], c.ape_m) << c.drive;
    if (frames < c.frames) continue;  // an error in percent is one of the whole way
    EXPECT_LT(evaluation["path"]["end_error_percent"], c.end_percent) << c.drive;
  }
}

}  // namespace
}  // namespace traverse
