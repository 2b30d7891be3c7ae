#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"

#include "end_to_end/batch_program.hpp"
#include "end_to_end/program.hpp"
#include "end_to_end/stand_in_systems.hpp"
#include "temporary_folder.hpp"

namespace traverse {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::BatchProcess;
using ::testing::HasSubstr;
using testing::ProgramResult;
using testing::run_program;
using testing::TemporaryFolder;

// What a program that hangs may take: nobody else comes near it.
#ifdef TRAVERSE_SANITIZED
constexpr const char* kPatience = "limits: {time_s: 40, attempts: 20}\n";
#else
constexpr const char* kPatience = "limits: {time_s: 4, attempts: 20}\n";
#endif

class BatchCommands : public ::testing::Test {
 protected:
  BatchCommands() { testing::write_stand_in_systems(folder_.path()); }

  ProgramResult batch(const std::string& plan, const std::string& out) const {
    files::write_text(folder_ / "plan.yaml", plan);
    return run_program("batch " + (folder_ / "plan.yaml").string() + " -o " +
                       (folder_ / out).string() + " --jobs 4");
  }
  std::map<std::string, std::vector<json>> runs_of(const std::string& out) const {
    std::map<std::string, std::vector<json>> runs;
    const json results = json::parse(files::read_text(folder_ / out / "results.json"));
    for (const json& run : results["runs"]) runs[run["pipeline"]].push_back(run);
    return runs;
  }
  /// Programs that work in the batch's folder.
  std::size_t programs_of(const std::string& out) const {
    std::size_t count = 0;
    const std::string mark = "TRAVERSE_BATCH_WORK=" + (folder_ / out).string();
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator("/proc", failure)) {
      std::ifstream stream(entry.path() / "environ", std::ios::binary);
      for (std::string variable; std::getline(stream, variable, '\0');) {
        if (variable.starts_with(mark)) ++count;
      }
    }
    return count;
  }

  TemporaryFolder folder_;
};

double figure(const json& run, const std::string& metric) {
  return run["metrics"][metric].get<double>();
}

TEST_F(BatchCommands, SixSystemsGiveTheRightRows) {
  const std::string plan = testing::stand_in_pipelines() + kPatience;
  const ProgramResult made = batch(plan + "repeats: 2\n", "out");
  EXPECT_EQ(made.status, 1);
  EXPECT_THAT(made.messages, HasSubstr("2 timed out, 2 crashed"));
  auto runs = runs_of("out");
  ASSERT_EQ(runs.size(), 6U);
  for (const char* name : {"right", "frame", "kitti"}) {
    for (const json& run : runs[name]) {
      ASSERT_EQ(run["outcome"], "ok") << name << ": " << run["reason"];
      EXPECT_LT(figure(run, "ape_translation_rmse"), 1e-6) << name;
      EXPECT_EQ(figure(run, "frames_used"), 6) << name;
      EXPECT_GT(figure(run, "wall_s"), 0);
      EXPECT_LT(figure(run, "wall_s"), 4) << "what is taken over after it does not count";
      EXPECT_GT(figure(run, "peak_memory_mb"), 0);
      EXPECT_FALSE(run["metrics"].contains("frame_median_ms"));
    }
    const std::string folder = runs[name][0]["folder"];
    const std::string record = files::read_text(folder_ / "out" / folder / "run.json");
    EXPECT_THAT(record, ::testing::Not(HasSubstr(".partial"))) << "the place that it had at work";
    EXPECT_THAT(record, HasSubstr("\"system/"));
    EXPECT_EQ(runs[name][0]["trajectory_sha256"], runs[name][1]["trajectory_sha256"]) << name;
  }
  for (const json& run : runs["crash"]) {
    EXPECT_EQ(run["outcome"], "crashed");
    EXPECT_THAT(run["reason"].get<std::string>(), HasSubstr("signal 11"));
  }
  for (const json& run : runs["hang"]) EXPECT_EQ(run["outcome"], "timed out");
  EXPECT_EQ(programs_of("out"), 0U) << "what hung has ended with what it had started";
  EXPECT_NE(runs["chance"][0]["trajectory_sha256"], runs["chance"][1]["trajectory_sha256"]);
  EXPECT_THAT(files::read_text(folder_ / "out/batch.html"),
              HasSubstr("1 of 4 combinations gave other trajectories when repeated: "));

  // A run is known by its program: what has changed is made again, and nothing else.
  files::write_text(folder_ / "right.sh",
                    "# another version\n" + files::read_text(folder_ / "right.sh"));
  EXPECT_THAT(batch(plan + "repeats: 2\n", "out").output,
              HasSubstr("2 made now, 10 finished before"));
}

TEST_F(BatchCommands, AKilledBatchLeavesNoProgramBehindAndLosesNothing) {
  const std::string plan = testing::stand_in_pipelines() + kPatience;
  files::write_text(folder_ / "plan.yaml", plan);
  const auto process = std::make_unique<BatchProcess>(folder_ / "plan.yaml", folder_ / "out");
  const auto began = std::chrono::steady_clock::now();
  while (programs_of("out") < 2) {  // the one that hangs, and what it waits for
    ASSERT_FALSE(process->has_ended()) << files::read_text(folder_ / "out.log");
    ASSERT_LT(std::chrono::steady_clock::now() - began, std::chrono::minutes(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  process->kill();
  batch(plan, "out");
  EXPECT_EQ(programs_of("out"), 0U);
  auto runs = runs_of("out");
  for (const char* name : {"right", "frame", "kitti", "chance"}) {
    EXPECT_EQ(runs[name][0]["outcome"], "ok") << name << ": " << runs[name][0]["reason"];
  }
  for (const auto& entry : fs::directory_iterator(folder_ / "out/runs")) {
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
  }
}

/// Kills the batch six times at moments that a fixed seed draws.
TEST_F(BatchCommands, KilledAtRandomMomentsLosesNothing) {
  files::write_text(folder_ / "slow.sh", "sleep 0.2\n" + files::read_text(folder_ / "right.sh"));
  const std::string plan = R"(pipelines:
  - {name: right, command: "sh {plan}/right.sh {recording}", trajectory: poses.txt, frame: body}
  - {name: slow, command: "sh {plan}/slow.sh {recording}", trajectory: poses.txt, frame: body}
  - name: kitti
    command: "sh {plan}/kitti.sh {format:kitti} {recording}"
    trajectory: results/latest/*.txt
    frame: body
recordings: [{simulate: town_short, arguments: {sensor: vlp16, first: 80, duration: 0.6}}]
repeats: 3
reports: false
limits: {time_s: 60, attempts: 20}
)";
  files::write_text(folder_ / "plan.yaml", plan);
  std::mt19937 random(20261201);
  for (int kill = 0; kill < 6; ++kill) {
    BatchProcess process(folder_ / "plan.yaml", folder_ / "out");
    std::this_thread::sleep_for(std::chrono::milliseconds(50 + random() % 350));
  }  // whose end kills
  const ProgramResult rest = batch(plan, "out");
  EXPECT_EQ(rest.status, 0) << rest.everything();
  EXPECT_THAT(rest.output, HasSubstr("9 of 9 runs are ok"));
  ASSERT_EQ(batch(plan, "undisturbed").status, 0);
  EXPECT_EQ(testing::comparable_results(folder_ / "out"),
            testing::comparable_results(folder_ / "undisturbed"));
  EXPECT_EQ(programs_of("out"), 0U);
  for (const auto& entry : fs::directory_iterator(folder_ / "out/runs")) {
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
  }
}

/// A stand-in for podman: it has the image "known" and starts the command in a session of its own,
/// as a container is not in the group of what started it.
TEST_F(BatchCommands, RunInAContainerWherePodmanIs) {
  fs::create_directory(folder_ / "bin");
  files::write_text(folder_ / "digest", "sha256:one");
  files::write_text(folder_ / "bin/podman",
                    "#!/bin/sh\necho \"$@\" >> '" + (folder_ / "podman.log").string() +
                        "'\n"
                        "if [ \"$1 $2\" = 'image inspect' ]; then\n"
                        "  [ \"$5\" = known ] || exit 125\n"
                        "  echo sha256:id $(cat '" +
                        (folder_ / "digest").string() +
                        "')\n  exit\nfi\n"
                        "while [ \"$1\" != sha256:id ]; do shift; done\nshift\n"
                        "exec setsid --wait \"$@\"\n");
  fs::permissions(folder_ / "bin/podman", fs::perms::owner_all);
  const std::string with_podman =
      "PATH='" + (folder_ / "bin").string() + "':\"$PATH\" " + TRAVERSE_PROGRAM;
  const auto plan = [](const std::string& image) {
    return R"(pipelines:
  - name: contained
    container: )" +
           image + R"(
    command: "(head -c 60000000 /dev/zero; sleep 0.3) | tail -c 60000000 > big; sh {plan}/right.sh {recording}"
    trajectory: poses.txt
    frame: body
recordings: [{simulate: town_short, arguments: {sensor: vlp16, first: 80, duration: 0.6}}]
reports: false
)";
  };
  const auto made = [&](const std::string& text, const std::string& options,
                        const std::string& program) {
    files::write_text(folder_ / "plan.yaml", text);
    return run_program("batch " + (folder_ / "plan.yaml").string() + options, program);
  };
  const std::string out = " -o " + (folder_ / "out").string();
  const ProgramResult first = made(plan("known"), out, with_podman);
  ASSERT_EQ(first.status, 0) << first.everything();
  const std::string told = files::read_text(folder_ / "podman.log");
  EXPECT_THAT(told, HasSubstr("run --rm --pull=never --volume " + folder_.path().string() + ":" +
                              folder_.path().string() + ":ro"));
  EXPECT_THAT(told, HasSubstr("--env TRAVERSE_BATCH_WORK --env OMP_NUM_THREADS sha256:id /bin/sh"));
  EXPECT_GT(figure(runs_of("out")["contained"][0], "peak_memory_mb"), 50)
      << "what the container takes counts";
  EXPECT_THAT(made(plan("known"), out, with_podman).output, HasSubstr("0 made now"));
  files::write_text(folder_ / "digest", "sha256:two");  // another image of that name
  EXPECT_THAT(made(plan("known"), out, with_podman).output, HasSubstr("1 made now"));

  EXPECT_THAT(made(plan("unknown"), " --check", with_podman).messages,
              HasSubstr("line 3: expected an image that podman has here (podman pull unknown)"));
  fs::create_directory(folder_ / "empty");
  const std::string with_nothing =
      "PATH='" + (folder_ / "empty").string() + "' " + TRAVERSE_PROGRAM;
  EXPECT_THAT(made(plan("known"), " --check", with_nothing).messages,
              HasSubstr("line 3: expected podman in the PATH"));
  files::write_text(folder_ / "image.sif", "an image");
  EXPECT_THAT(made(plan("image.sif"), " --check", with_nothing).messages,
              HasSubstr("line 3: expected apptainer in the PATH"));
}

TEST_F(BatchCommands, AWrongCommandIsToldWithItsLine) {
  const auto wrong = [&](const std::string& pipeline) {
    return batch("recordings: [" + (folder_ / "right.sh").string() + "]\npipelines:\n  - " +
                     pipeline + "\n",
                 "out")
        .messages;
  };
  EXPECT_THAT(wrong("{name: a, command: 'x {recordings}', trajectory: t}"),
              HasSubstr("line 3: expected {recording}, {format:NAME}, {out}, {threads}, {config}, "
                        "{plan} or a key under 'set' or 'grid', found '{recordings}'"));
  EXPECT_THAT(wrong("{name: a, command: 'x {format:las}', trajectory: t}"),
              HasSubstr("line 3: expected {format:kitti}, pcd, ply, bag, mcap or rawlog"));
  EXPECT_THAT(wrong("{name: a, command: 'x {recording}'}"),
              HasSubstr("line 3: expected a 'trajectory': what the command writes, found none"));
  EXPECT_THAT(wrong("{command: 'x {recording}', trajectory: t}"),
              HasSubstr("line 3: expected a 'name' of the command"));
  EXPECT_THAT(wrong("{name: a, command: x, trajectory: t, config: none.yaml}"),
              HasSubstr("expected a file that is there"));
}

}  // namespace
}  // namespace traverse
