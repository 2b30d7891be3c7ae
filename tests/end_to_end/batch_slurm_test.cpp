#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"

#include "end_to_end/batch_program.hpp"
#include "end_to_end/program.hpp"
#include "end_to_end/stand_in_systems.hpp"
#include "temporary_folder.hpp"

namespace traverse {
namespace {

namespace fs = std::filesystem;
using testing::comparable_results;
using ::testing::HasSubstr;
using testing::ProgramResult;
using testing::run_program;
using testing::TemporaryFolder;

constexpr const char* kPlan = R"(
recordings:
  - {simulate: town_short, arguments: {first: 80, duration: 0.3}}
pipelines:
  - {preset: floam, set: {start.scans: 0, first_registration_steps: 2}}
grid: {solver.huber_m: [0.05, 0.1, 0.15, 0.2, 0.25]}
repeats: 2
reports: false
limits: {time_s: 300, memory_mb: 2000}
slurm: {runs_per_task: 2, max_at_once: 4, options: {nice: 10}}
)";

/// A real Slurm of one node on the loopback, begun for these tests.
class BatchOnSlurm : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    slurm_ = new TemporaryFolder();
    const int status = std::system((script("start") + " > " + messages() + " 2>&1").c_str());
    is_up_ = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (is_up_) ::setenv("SLURM_CONF", (*slurm_ / "slurm.conf").c_str(), 1);
  }
  static void TearDownTestSuite() {
    if (is_up_) std::system(script("stop").c_str());
    ::unsetenv("SLURM_CONF");
    delete slurm_;
  }
  void SetUp() override {
    if (!is_up_) GTEST_SKIP() << "no Slurm here: " << files::read_text(messages());
  }

  static std::string script(const std::string& name) {
    return std::string(TRAVERSE_SOURCE_DIR) + "/tests/slurm/" + name + " " +
           slurm_->path().string();
  }
  static std::string messages() { return (*slurm_ / "messages").string(); }

  ProgramResult batch(const std::string& plan, const std::string& out,
                      const std::string& arguments) const {
    files::write_text(folder_ / "plan.yaml", plan);
    return run_program("batch " + (folder_ / "plan.yaml").string() + " -o " +
                       (folder_ / out).string() + " " + arguments);
  }

  TemporaryFolder folder_;
  static inline TemporaryFolder* slurm_ = nullptr;
  static inline bool is_up_ = false;
};

TEST_F(BatchOnSlurm, AnArrayGivesTheSameResultsAsThisMachine) {
  const ProgramResult cluster = batch(kPlan, "cluster", "--executor slurm");
  ASSERT_EQ(cluster.status, 0) << cluster.everything();
  EXPECT_THAT(cluster.output, HasSubstr("10 of 10 runs are ok; 10 made now"));
  ASSERT_EQ(batch(kPlan, "local", "").status, 0);
  EXPECT_EQ(comparable_results(folder_ / "cluster"), comparable_results(folder_ / "local"));
  const ProgramResult again = batch(kPlan, "cluster", "--executor slurm");
  EXPECT_THAT(again.output, HasSubstr("0 made now, 10 finished before"));
}

TEST_F(BatchOnSlurm, CancelledItCanBeGoneOnWith) {
  std::string plan = kPlan;
  plan.replace(plan.find("duration: 0.3"), 13, "duration: 0.9");
  ASSERT_EQ(batch(plan, "out", "--executor slurm --no-wait").status, 0);
  const auto finished = [&] {
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(folder_ / "out/runs")) {
      count += entry.path().filename().string().starts_with('.') ? 0 : 1;
    }
    return count;
  };
  for (int i = 0; i < 600 && finished() == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  ASSERT_GT(finished(), 0U);
  const ProgramResult cancelled = run_program("batch cancel " + (folder_ / "out").string());
  EXPECT_EQ(cancelled.status, 0) << cancelled.everything();
  for (int i = 0; i < 300; ++i) {
    if (run_program("batch status " + (folder_ / "out").string()).output.find("(") ==
        std::string::npos) {
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  const std::size_t before = finished();
  EXPECT_LT(before, 10U) << "there was nothing left to cancel";
  const ProgramResult rest = batch(plan, "out", "--executor slurm");
  EXPECT_EQ(rest.status, 0) << rest.everything();
  EXPECT_THAT(rest.output, HasSubstr("10 of 10 runs are ok"));
}

TEST_F(BatchOnSlurm, ASubmissionThatSlurmRefusesIsToldWithItsMessage) {
  std::string plan = kPlan;
  plan.replace(plan.find("nice: 10"), 8, "partition: nowhere");
  const ProgramResult result = batch(plan, "out", "--executor slurm");
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.messages, HasSubstr("nowhere"));
}

TEST_F(BatchOnSlurm, ProgramsThatAreNotOursGiveTheSameRows) {
  testing::write_stand_in_systems(folder_.path());
  const std::string plan = testing::stand_in_pipelines() + "limits: {time_s: 4}\n";
  const ProgramResult cluster = batch(plan, "cluster", "--executor slurm");
  EXPECT_EQ(cluster.status, 1);
  EXPECT_THAT(cluster.messages, HasSubstr("1 timed out, 1 crashed"));
  EXPECT_THAT(batch(plan, "local", "").messages, HasSubstr("1 timed out, 1 crashed"));
  auto on_cluster = comparable_results(folder_ / "cluster");
  auto here = comparable_results(folder_ / "local");
  ASSERT_EQ(on_cluster.size(), 7U);
  const auto is_chance = [](const std::vector<std::string>& row) { return row[1] == "chance"; };
  EXPECT_EQ(std::erase_if(on_cluster, is_chance), 1U);
  EXPECT_EQ(std::erase_if(here, is_chance), 1U);
  EXPECT_EQ(on_cluster, here);
}

/// The command that waits is killed at moments that a fixed seed draws.
TEST_F(BatchOnSlurm, ProgramsThatAreNotOursLoseNothingWhenItIsKilled) {
  testing::write_stand_in_systems(folder_.path());
  const std::string plan = R"(pipelines:
  - {name: right, command: "sh {plan}/right.sh {recording}", trajectory: poses.txt, frame: body}
  - name: kitti
    command: "sh {plan}/kitti.sh {format:kitti} {recording}"
    trajectory: results/latest/*.txt
    frame: body
recordings: [{simulate: town_short, arguments: {sensor: vlp16, first: 80, duration: 0.6}}]
repeats: 2
reports: false
limits: {time_s: 60}
)";
  files::write_text(folder_ / "plan.yaml", plan);
  std::mt19937 random(20261202);
  const std::string rest = "batch " + (folder_ / "plan.yaml").string() + " -o " +
                           (folder_ / "cluster").string() + " --executor slurm";
  for (int kill = 0; kill < 2; ++kill) {
    const auto ms = 200 + random() % 800;
    run_program(
        "-s KILL 0." + std::to_string(1000 + ms).substr(1) + " " + TRAVERSE_PROGRAM + " " + rest,
        "timeout");
  }
  const ProgramResult last = run_program(rest);
  EXPECT_EQ(last.status, 0) << last.everything();
  EXPECT_THAT(last.output, HasSubstr("4 of 4 runs are ok"));
  ASSERT_EQ(batch(plan, "local", "").status, 0);
  EXPECT_EQ(comparable_results(folder_ / "cluster"), comparable_results(folder_ / "local"));
}

}  // namespace
}  // namespace traverse
