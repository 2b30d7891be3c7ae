#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"

#include "end_to_end/batch_program.hpp"
#include "end_to_end/program.hpp"
#include "temporary_folder.hpp"

namespace traverse {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using testing::BatchProcess;
using testing::comparable_results;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramResult;
using testing::run_program;
using testing::TemporaryFolder;

/// Forty short runs: a street of three scans, without the search for the start.
constexpr const char* kForty = R"(
recordings:
  - {simulate: town_short, arguments: {first: 80, duration: 0.3}}
pipelines:
  - {preset: floam, set: {start.scans: 0, first_registration_steps: 2}}
grid:
  solver.huber_m: [0.05, 0.1, 0.15, 0.2, 0.25]
  map.radius_m: [60, 80]
repeats: 4
reports: false
limits: {time_s: 300, attempts: 20}
)";

class Batch : public ::testing::Test {
 protected:
  /// Forty runs that nobody disturbed, made once for all tests.
  static void SetUpTestSuite() {
    shared_ = new TemporaryFolder();
    files::write_text(*shared_ / "forty.yaml", kForty);
    const ProgramResult result =
        run_program("batch " + forty().string() + " -o " + undisturbed().string() + " --jobs 4");
    ASSERT_EQ(result.status, 0) << result.everything();
  }
  static void TearDownTestSuite() { delete shared_; }

  static fs::path forty() { return *shared_ / "forty.yaml"; }
  static fs::path undisturbed() { return *shared_ / "undisturbed"; }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  ProgramResult batch(const std::string& plan, const std::string& arguments) const {
    files::write_text(folder_ / "plan.yaml", plan);
    return run_program("batch " + file("plan.yaml") + " " + arguments);
  }

  TemporaryFolder folder_;
  static inline TemporaryFolder* shared_ = nullptr;
};

TEST_F(Batch, EveryRunIsARowAFolderAndARowOfThePage) {
  EXPECT_EQ(comparable_results(undisturbed()).size(), 41U);
  const json results = json::parse(files::read_text(undisturbed() / "results.json"));
  for (const json& run : results["runs"]) {
    EXPECT_EQ(run["outcome"], "ok");
    EXPECT_TRUE(fs::exists(undisturbed() / run["folder"] / "trajectory.tum"));
  }
  EXPECT_THAT(files::read_text(undisturbed() / "batch.html"),
              AllOf(HasSubstr("40 of 40 runs ok"), HasSubstr("bit for bit")));
  EXPECT_THAT(files::read_text(undisturbed() / "leaderboard.tex"), HasSubstr("\\toprule"));
}

TEST_F(Batch, ThePageShowsNoErrorInABrowser) {
  if (std::system("command -v chromium-headless-shell > /dev/null") != 0) {
    GTEST_SKIP() << "chromium-headless-shell is not installed";
  }
  const std::string command =
      "chromium-headless-shell --no-sandbox --disable-gpu --enable-logging=stderr --v=0 "
      "--user-data-dir=" +
      file("browser") + " --virtual-time-budget=5000 --dump-dom file://" +
      (undisturbed() / "batch.html").string() + " > " + file("dom.html") + " 2> " +
      file("browser.log");
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_THAT(files::read_text(file("browser.log")), Not(HasSubstr("CONSOLE")));
  const std::string page = files::read_text(file("dom.html"));
  EXPECT_THAT(page, AllOf(HasSubstr("40 rows"), HasSubstr("aria-label=\"Box plots of APE\""),
                          HasSubstr("aria-label=\"APE over solver.huber_m\"")));
}

TEST_F(Batch, FinishedRunsAreFoundAndChangedOnesMade) {
  fs::copy(undisturbed(), folder_ / "out", fs::copy_options::recursive);
  ProgramResult again = batch(kForty, "-o " + file("out"));
  EXPECT_EQ(again.status, 0) << again.everything();
  EXPECT_THAT(again.output, HasSubstr("0 made now, 40 finished before"));
  std::string changed = kForty;
  changed.replace(changed.find("[60, 80]"), 8, "[60, 90]");
  again = batch(changed, "-o " + file("out"));
  EXPECT_THAT(again.output, HasSubstr("20 made now, 20 finished before"));
}

/// Kills runs and the batch ten times at random moments.
TEST_F(Batch, KilledAtAnyMomentNothingIsLostRepeatedOrHalfWritten) {
  const fs::path out = folder_ / "out";
  std::mt19937 random(20261122);
  int kills = 0;
  int of_the_batch = 0;
  auto process = std::make_unique<BatchProcess>(forty(), out);
  const auto began = std::chrono::steady_clock::now();
  while (kills < 10) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100 + random() % 500));
    ASSERT_LT(std::chrono::steady_clock::now() - began, std::chrono::minutes(10));
    ASSERT_FALSE(process->has_ended())
        << "it was over after " << kills << " kills: " << files::read_text(out.string() + ".log");
    const std::vector<pid_t> workers = process->workers();
    if (random() % 2 == 0 && of_the_batch < 5) {
      process->kill();
      ++of_the_batch;
      process = std::make_unique<BatchProcess>(forty(), out);
    } else {
      if (workers.empty()) continue;
      ::kill(workers[random() % workers.size()], SIGKILL);
    }
    ++kills;
  }
  EXPECT_GE(of_the_batch, 2);
  while (!process->has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(process->exit_status(), 0) << files::read_text(out.string() + ".log");

  EXPECT_EQ(comparable_results(out), comparable_results(undisturbed()));
  std::size_t folders = 0;
  for (const auto& entry : fs::directory_iterator(out / "runs")) {
    EXPECT_THAT(entry.path().filename().string(), Not(HasSubstr("partial")));
    ++folders;
  }
  EXPECT_EQ(folders, 40U);
  // What was finished was not made again.
  std::map<std::string, int> finished;
  for (const auto& journal : fs::directory_iterator(out / "journal")) {
    for (files::LineReader lines(journal.path()); lines.next();) {
      const json line = json::parse(lines.line(), nullptr, false);
      if (line.is_object() && line["event"] == "finished") ++finished[line["id"]];
    }
  }
  for (const auto& [id, times] : finished) EXPECT_EQ(times, 1) << id;
}

TEST_F(Batch, ShardsMakeEachRunOnceAndTogetherAll) {
  for (const char* shard : {"1/3", "2/3", "3/3"}) {
    const ProgramResult result = batch(kForty, "-o " + file("out") + " --shard " + shard);
    EXPECT_EQ(result.status, 0) << result.everything();
    const char* made = std::string(shard) == "1/3" ? "14 made now" : "13 made now";
    EXPECT_THAT(result.output, HasSubstr(made)) << shard;
  }
  EXPECT_EQ(comparable_results(folder_ / "out"), comparable_results(undisturbed()));
  EXPECT_EQ(batch(kForty, "-o " + file("out") + " --shard 4/3").status, 2);
}

TEST_F(Batch, EveryFailureIsARowAndTheRestGoesOn) {
  files::write_text(folder_ / "broken.rawlog", "no rawlog");
  const std::string recordings =
      "recordings:\n  - broken.rawlog\n  - {simulate: town_short, arguments: {first: 80, duration: "
      "0.3}}\n"
      "pipelines: [floam]\nreports: false\nmetrics: [wall_s]\n";
  const ProgramResult result = batch(recordings, "-o " + file("out"));
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.messages, HasSubstr("1 failed"));
  json results = json::parse(files::read_text(folder_ / "out/results.json"));
  EXPECT_EQ(results["runs"][0]["outcome"], "failed");
  EXPECT_THAT(results["runs"][0]["reason"].get<std::string>(), HasSubstr("broken.rawlog"));
  EXPECT_EQ(results["runs"][1]["outcome"], "ok");
  EXPECT_THAT(files::read_text(folder_ / "out/batch.html"), HasSubstr("failed: 1 run"));

  batch(recordings + "limits: {time_s: 0.1}\n", "-o " + file("slow"));
  results = json::parse(files::read_text(folder_ / "slow/results.json"));
  EXPECT_EQ(results["runs"][1]["outcome"], "timed out");
  batch(recordings + "limits: {time_s: 300, memory_mb: 100}\n", "-o " + file("slow"));
  results = json::parse(files::read_text(folder_ / "slow/results.json"));
  EXPECT_EQ(results["runs"][1]["outcome"], "out of memory") << "another limit: made again";
  const ProgramResult enough = batch(recordings, "-o " + file("slow"));
  results = json::parse(files::read_text(folder_ / "slow/results.json"));
  EXPECT_EQ(results["runs"][1]["outcome"], "ok");
}

TEST_F(Batch, ABrokenBudgetIsTold) {
  const std::string plan =
      "recordings: [{simulate: town_short, arguments: {first: 80, duration: 0.3}}]\npipelines: "
      "[floam]\n"
      "reports: false\nmetrics: [wall_s]\nbudgets: {wall_s: 0.001}\n";
  const ProgramResult result = batch(plan, "-o " + file("out"));
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.messages, HasSubstr("1 over budget"));
}

TEST_F(Batch, ComparesWithABaseline) {
  fs::copy(undisturbed(), folder_ / "out", fs::copy_options::recursive);
  const ProgramResult result =
      batch(kForty, "-o " + file("out") + " --baseline " + undisturbed().string());
  EXPECT_EQ(result.status, 0) << result.everything();
  EXPECT_THAT(files::read_text(folder_ / "out/batch.html"),
              HasSubstr("Against the baseline:</strong> 0 improved"));
}

TEST_F(Batch, WrongPlansAreRefusedAtOnce) {
  const auto refused = [&](const std::string& plan, const std::string& part) {
    const ProgramResult result = batch(plan, "-o " + file("out"));
    EXPECT_EQ(result.status, 2) << plan;
    EXPECT_THAT(result.everything(), AllOf(HasSubstr("plan.yaml, line "), HasSubstr(part)));
    EXPECT_FALSE(fs::exists(folder_ / "out")) << plan;
  };
  const std::string street = "recordings: [{simulate: town_short}]\n";
  refused(street + "pipeline: [floam]\n", "did you mean 'pipelines'");
  refused(street + "pipelines: [floam, floam]\n", "again");
  refused("recordings: [nowhere.rawlog]\npipelines: [floam]\n", "nowhere.rawlog");
  refused("recordings: [{simulate: moon}]\npipelines: [floam]\n", "moon");
  refused("recordings: [{simulate: town_short, arguments: {size: 3}}]\npipelines: [floam]\n",
          "--size");
  refused(street + "pipelines: [floam]\nlimits: {threads: 256}\n", "cores");
  refused(street + "pipelines: [floam]\nlimits: {time_s: 0}\n", "limits.time_s");
  refused(street + "pipelines: [floam\n", "YAML");
  EXPECT_EQ(run_program("batch").status, 2);
  EXPECT_EQ(run_program("batch " + file("none.yaml") + " -o x").status, 2);
}

TEST_F(Batch, CheckExplainsAndRunsNothing) {
  const ProgramResult result = batch(kForty, "--check");
  EXPECT_EQ(result.status, 0) << result.everything();
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("= 40 runs"), HasSubstr("traverse simulate town_short"),
                    HasSubstr("solver.huber_m in 0.05")));
}

}  // namespace
}  // namespace traverse
