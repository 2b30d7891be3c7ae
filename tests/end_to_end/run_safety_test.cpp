#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/digest.hpp"
#include "traverse/files/text_file.hpp"

#include "end_to_end/program.hpp"
#include "end_to_end/program_process.hpp"
#include "temporary_folder.hpp"

namespace traverse {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::ProgramProcess;
using testing::run_program;

#ifdef TRAVERSE_SANITIZED
constexpr int kKills = 3;
#else
constexpr int kKills = 20;
#endif

/// What is not the program's stays, what was complete stays whole, and nothing half-written gets a
/// name: for run, localize and report.
class RunSafety : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    recordings_ = new testing::TemporaryFolder;
    for (const auto& [name, options] :
         {std::pair{"short", "--first 80 --duration 0.4"}, {"long", "--first 40 --duration 6"}}) {
      const auto simulated = run_program(std::string("simulate town_short --sensor vlp16 ") +
                                         options + " -o " + recording(name));
      ASSERT_EQ(simulated.status, 0) << simulated.messages;
    }
    const auto made =
        run_program("run " + recording("short") + " -o " + (*recordings_ / "made").string());
    ASSERT_EQ(made.status, 0) << made.messages;
  }
  static void TearDownTestSuite() { delete recordings_; }

  static std::string recording(const std::string& name) {
    return (*recordings_ / (name + ".rawlog")).string();
  }
  std::string at(const std::string& name) const { return (folder_ / name).string(); }
  static json record(const std::string& run) {
    return json::parse(files::read_text(fs::path(run) / "run.json"));
  }

  /// A complete run of the short recording, with files in it that are somebody's own.
  std::string earlier_run() const {
    fs::copy(*recordings_ / "made", at("run"), fs::copy_options::recursive);
    for (const auto& [name, text] : foreign()) {
      fs::create_directories((folder_ / "run" / name).parent_path());
      files::write_text(folder_ / "run" / name, text);
    }
    return at("run");
  }
  static std::map<std::string, std::string> foreign() {
    return {{"notes.txt", "mine"}, {"images/holiday.png", "mine too"}, {"sub/map.ply", "and mine"}};
  }
  static void expect_foreign_files_in(const std::string& run) {
    for (const auto& [name, text] : foreign()) {
      EXPECT_EQ(files::read_text(fs::path(run) / name), text) << name;
    }
  }

  static std::map<std::string, std::string> digests(const fs::path& folder) {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (!entry.is_regular_file()) continue;
      found[fs::relative(entry.path(), folder).string()] = files::sha256_of_file(entry.path());
    }
    return found;
  }
  /// The same without what a killed process may leave under hidden names until the next comes.
  static std::map<std::string, std::string> visible(const fs::path& folder) {
    auto found = digests(folder);
    std::erase_if(found, [](const auto& file) {
      return file.first.starts_with('.') || file.first.find("/.") != std::string::npos;
    });
    return found;
  }
  /// Files of reports whose bytes are the same each time are left in the list; of others (PDF tells
  /// when it was made, and the names within an SVG are counted) it is looked whether they are
  /// whole.
  static std::map<std::string, std::string> same_each_time(
      const fs::path& run, std::map<std::string, std::string> files_of_run) {
    std::erase_if(files_of_run, [&](const auto& file) {
      const bool pdf = file.first.ends_with(".pdf");
      if (!pdf && !file.first.ends_with(".svg")) return false;
      const std::string text = files::read_text(run / file.first);
      const std::string end = text.substr(text.size() - std::min<std::size_t>(text.size(), 10));
      EXPECT_THAT(end, HasSubstr(pdf ? "%%EOF" : "</svg>")) << file.first;
      return true;
    });
    return files_of_run;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      if (entry.path().extension() != ".log") found.push_back(entry.path().filename().string());
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  std::string log() const { return fs::exists(at("a.log")) ? files::read_text(at("a.log")) : ""; }
  static bool wait_until(const std::function<bool()>& condition) {
    for (int i = 0; i < 120'000; ++i) {
      if (condition()) return true;
      std::this_thread::sleep_for(1ms);
    }
    return false;
  }
  std::string last_line() const {
    const std::string text = log();
    return text.substr(text.rfind('\n', text.size() - 2) + 1);
  }

  static inline testing::TemporaryFolder* recordings_ = nullptr;
  testing::TemporaryFolder folder_;
};

TEST_F(RunSafety, ForeignFilesOutliveANewRun) {
  const std::string run = earlier_run();
  const auto before = record(run)["started_utc"];
  const auto result = run_program("run " + recording("short") + " --last 2 -o " + run);
  EXPECT_EQ(result.status, 0) << result.messages;
  EXPECT_EQ(record(run)["frames"]["used"], 3);
  EXPECT_TRUE(fs::exists(run + "/report.html"));
  EXPECT_THAT(files::read_text(run + "/report.html"), Not(HasSubstr("traverse-work")));
  EXPECT_THAT(files::read_text(run + "/run.json"), Not(HasSubstr("traverse-work")));
  EXPECT_THAT(result.everything(), Not(HasSubstr("traverse-work")));
  expect_foreign_files_in(run);
  EXPECT_THAT(names(), ElementsAre("run"));
}

TEST_F(RunSafety, FoldersThatAreNoRunAreRefusedAndNotTouched) {
  fs::create_directories(folder_ / "mine/images");
  for (const char* name : {"images/holiday.png", "map.ply", "reference.tum", "frames.csv"}) {
    files::write_text(folder_ / "mine" / name, name);
  }
  fs::copy(recording("short"), folder_ / "mine/drive.rawlog");
  const std::string run = earlier_run();
  const auto before = digests(folder_.path());
  for (const std::string& command :
       {"run " + recording("short") + " -o " + at("mine"),
        "run " + at("mine/drive.rawlog") + " -o " + at("mine"),
        "run " + at("mine/drive.rawlog") + " -o " + folder_.path().string(),
        "localize " + recording("short") + " --map " + run + " -o " + at("mine"),
        "localize " + recording("short") + " --map " + run + " -o " + run}) {
    const auto result = run_program(command);
    EXPECT_EQ(result.status, 1) << command;
    EXPECT_THAT(result.messages, AllOf(HasSubstr("cannot be written"), HasSubstr("-o"))) << command;
  }
  EXPECT_EQ(digests(folder_.path()), before);
}

TEST_F(RunSafety, TheWorkingDirectoryCanBeReplaced) {
  const std::string run = earlier_run();
  const auto result = run_program("run " + recording("short") + " --last 2 --no-report -o .",
                                  "cd " + run + " && " + TRAVERSE_PROGRAM);
  EXPECT_EQ(result.status, 0) << result.messages;
  EXPECT_THAT(result.messages, HasSubstr("the working directory was replaced"));
  EXPECT_EQ(record(run)["frames"]["used"], 3);
  expect_foreign_files_in(run);
  EXPECT_THAT(names(), ElementsAre("run"));
}

TEST_F(RunSafety, LocalizeLeavesForeignFiles) {
  const std::string run = earlier_run();
  const auto map = run_program("run " + recording("long") + " --last 30 -o " + at("map") +
                               " --set slam.gnss.use=false --no-report --no-hash");
  ASSERT_EQ(map.status, 0) << map.messages;
  const auto result = run_program("localize " + recording("long") + " --first 8 --last 14 --map " +
                                  at("map") + " -o " + run + " --no-report --no-hash");
  EXPECT_EQ(result.status, 0) << result.messages;
  EXPECT_EQ(record(run)["frames"]["used"], 7);
  expect_foreign_files_in(run);
}

TEST_F(RunSafety, CtrlCOverAnEarlierRunLeavesBoth) {
  const std::string run = earlier_run();
  const auto before = digests(run);
  ProgramProcess process({"run", recording("long"), "-o", run}, at("a.log"));
  ASSERT_TRUE(wait_until([&] { return log().find("frames") != std::string::npos; })) << log();
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(), 130) << log();
  EXPECT_THAT(log(), AllOf(HasSubstr("stopping: writing what is done so far"),
                           HasSubstr("Ctrl-C again"), HasSubstr("`traverse report")));
  EXPECT_THAT(last_line(), AllOf(HasSubstr("interrupted"), HasSubstr(run + ".interrupted"),
                                 HasSubstr("as it was")));
  EXPECT_EQ(digests(run), before);
  EXPECT_THAT(names(), ElementsAre("run", "run.interrupted"));
  const json stopped = record(run + ".interrupted");
  EXPECT_EQ(stopped["status"], "interrupted");
  EXPECT_GT(stopped["frames"]["used"], 0);
  EXPECT_LT(stopped["frames"]["used"], 60);
  EXPECT_FALSE(fs::exists(run + ".interrupted/images"));
  const auto report = run_program("report " + run + ".interrupted --picture-width 480");
  EXPECT_EQ(report.status, 0) << report.messages;
}

TEST_F(RunSafety, SigtermWithoutAnEarlierRunLeavesItUnderItsName) {
  ProgramProcess process({"run", recording("long"), "-o", at("run")}, at("a.log"));
  ASSERT_TRUE(wait_until([&] { return log().find("frames") != std::string::npos; })) << log();
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(), 143) << log();
  EXPECT_EQ(record(at("run"))["status"], "interrupted");
  EXPECT_THAT(names(), ElementsAre("run"));
}

TEST_F(RunSafety, ASecondSignalEndsAtOnceAndLeavesNothing) {
  const std::string run = earlier_run();
  const auto before = digests(run);
  ProgramProcess process({"run", recording("long"), "-o", run}, at("a.log"));
  ASSERT_TRUE(wait_until([&] { return log().find("frames") != std::string::npos; })) << log();
  process.signal(SIGINT);
  // Of two signals that wait for a busy process the handler of the later one runs first.
  ASSERT_TRUE(wait_until([&] { return log().find("stopping") != std::string::npos; })) << log();
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(), 143) << log();
  EXPECT_EQ(digests(run), before);
  EXPECT_THAT(names(), ElementsAre("run"));
}

TEST_F(RunSafety, CtrlCBeforeTheFirstFrameLeavesTheEarlierRun) {
  const std::string run = earlier_run();
  const auto before = digests(run);
  ProgramProcess process({"run", recording("long"), "-o", run}, at("a.log"));
  ASSERT_TRUE(wait_until([&] { return fs::exists(folder_ / ".run.traverse-work/run"); }));
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(), 130) << log();
  EXPECT_EQ(digests(run), before);
}

TEST_F(RunSafety, CtrlCWhileTheReportIsDrawnEndsTheDrawingAlone) {
  const std::string run = earlier_run();
  ProgramProcess process({"run", recording("short"), "-o", run, "--last", "2"}, at("a.log"));
  ASSERT_TRUE(wait_until(
      [&] { return fs::exists(folder_ / ".run.traverse-work/run/.report.traverse-work"); }));
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(), 130) << log();
  EXPECT_THAT(log(), HasSubstr("stopping: the run is complete; its report is left out"));
  EXPECT_EQ(record(run)["status"], "ok");
  EXPECT_EQ(record(run)["frames"]["used"], 3);
  EXPECT_FALSE(fs::exists(run + "/report.html"));
  expect_foreign_files_in(run);
  EXPECT_THAT(names(), ElementsAre("run"));
}

TEST_F(RunSafety, TwoRunsIntoOneFolderTheSecondIsRefused) {
  ProgramProcess first({"run", recording("long"), "-o", at("run"), "--no-report"}, at("a.log"));
  ASSERT_TRUE(wait_until([&] { return log().find("frames") != std::string::npos; })) << log();
  const auto second = run_program("run " + recording("short") + " -o " + at("run"));
  EXPECT_EQ(second.status, 1);
  EXPECT_THAT(second.messages, AllOf(HasSubstr(at("run")), HasSubstr("process")));
  EXPECT_EQ(first.wait(), 0) << log();
  EXPECT_EQ(record(at("run"))["frames"]["used"], 60);
  EXPECT_THAT(names(), ElementsAre("run"));
}

TEST_F(RunSafety, AFailureInTheMiddleKeepsWhatWasEstimated) {
  const std::string run = earlier_run();
  const auto before = digests(run);
  // As on a full disk: no file grows beyond 1 MB (dash counts 512 bytes), which what a run keeps of
  // its frames soon does.
  const auto run_on_full_disk = [&](const std::string& options) {
    return run_program("", "sh -c \"ulimit -f 2000; trap '' XFSZ; exec '" +
                               std::string(TRAVERSE_PROGRAM) + "' run " + recording("long") +
                               " --no-hash --no-report -o " + run + options + "\"");
  };
  const auto result = run_on_full_disk("");
  EXPECT_EQ(result.status, 1) << result.everything();
  EXPECT_THAT(result.messages,
              AllOf(HasSubstr("cannot be written"), HasSubstr("kept: this run stands in"),
                    HasSubstr(run + ".interrupted"), Not(HasSubstr("traverse-work"))));
  EXPECT_EQ(digests(run), before);
  const json failed = record(run + ".interrupted");
  EXPECT_EQ(failed["status"], "failed");
  EXPECT_THAT(failed["reason"].get<std::string>(), Not(HasSubstr("traverse-work")));
  EXPECT_GT(failed["frames"]["used"], 3);
  EXPECT_LT(failed["frames"]["used"], 60);
  for (const char* name : {"trajectory.tum", "frames.csv", "evaluation.json"}) {
    EXPECT_TRUE(fs::exists(run + ".interrupted/" + name)) << name;
  }
  EXPECT_EQ(run_on_full_disk(" --force").status, 1);
  EXPECT_EQ(record(run)["status"], "failed");
  expect_foreign_files_in(run);
}

/// Drawing takes most of a run's time: few of the kills wait for it.
class KilledRun : public RunSafety, public ::testing::WithParamInterface<bool> {};
INSTANTIATE_TEST_SUITE_P(WithReportOrNot, KilledRun, ::testing::Bool());

TEST_P(KilledRun, LeavesTheEarlierOneOrIsComplete) {
  const std::string run = earlier_run();
  const int kills = GetParam() ? kKills / 4 + 1 : kKills;
  std::vector<std::string> words{"run", recording("short"), "-o", run, "--last", "2"};
  if (!GetParam()) words.emplace_back("--no-report");
  const auto began = std::chrono::steady_clock::now();
  ASSERT_EQ(ProgramProcess(words, at("a.log")).wait(), 0) << log();
  const auto whole = std::chrono::steady_clock::now() - began;
  const std::string trajectory = files::sha256_of_file(run + "/trajectory.tum");
  auto before = visible(run);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1.1);
  for (int kill = 0; kill < kills; ++kill) {
    ProgramProcess process(words, at("a.log"));
    std::this_thread::sleep_for(share(random) * whole);
    process.signal(SIGKILL);
    process.wait();
    const auto after = visible(run);
    EXPECT_EQ(after.size(), before.size());
    for (const auto& [name, digest] : before) EXPECT_TRUE(after.contains(name)) << name;
    EXPECT_EQ(after.at("trajectory.tum"), trajectory);
    if (after.at("run.json") == before.at("run.json")) {
      EXPECT_EQ(after, before) << kill;
    }
    EXPECT_EQ(record(run)["status"], "ok");
    expect_foreign_files_in(run);
    for (const std::string& name : names()) {
      EXPECT_TRUE(name == "run" || name == ".run.traverse-work") << name;
    }
    before = after;
  }
  ASSERT_EQ(ProgramProcess(words, at("a.log")).wait(), 0) << log();
  EXPECT_EQ(digests(run).size(), before.size()) << "nothing is left of killed runs";
  EXPECT_THAT(names(), ElementsAre("run"));
}

TEST_F(RunSafety, KilledOrStoppedAtAnyMomentAReportLeavesTheEarlierOne) {
  const std::string run = earlier_run();
  const auto words = std::vector<std::string>{"report", run, "--picture-width", "480"};
  const auto began = std::chrono::steady_clock::now();
  ASSERT_EQ(ProgramProcess(words, at("a.log")).wait(), 0) << log();
  const auto whole = std::chrono::steady_clock::now() - began;
  const auto before = same_each_time(run, digests(run));
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0, 1.1);
  for (int kill = 0; kill < kKills; ++kill) {
    ProgramProcess process(words, at("a.log"));
    std::this_thread::sleep_for(share(random) * whole);
    process.signal(SIGKILL);
    process.wait();
    EXPECT_EQ(same_each_time(run, visible(run)), before) << kill;
  }
  // What the last killed one left is not to be taken for the work of the next.
  ASSERT_EQ(ProgramProcess(words, at("a.log")).wait(), 0) << log();
  for (const int signal : {SIGINT, SIGTERM}) {
    ProgramProcess process(words, at("a.log"));
    ASSERT_TRUE(wait_until([&] { return fs::exists(run + "/.report.traverse-work/images"); }));
    process.signal(signal);
    EXPECT_EQ(process.wait(), 128 + signal) << log();
    EXPECT_EQ(same_each_time(run, digests(run)), before) << "no hidden file either";
  }
  ASSERT_EQ(ProgramProcess(words, at("a.log")).wait(), 0) << log();
  EXPECT_EQ(same_each_time(run, digests(run)), before);
}

}  // namespace
}  // namespace traverse
