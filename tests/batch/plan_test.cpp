#include "traverse/batch/plan.hpp"

#include <filesystem>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/batch/local_executor.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "batch/made_plan.hpp"

namespace traverse::batch {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

constexpr const char* kSmall = "recordings: [a.rawlog]\npipelines: [floam]\n";

/// A folder with two files that could be recordings.
class PlanTest : public ::testing::Test {
 protected:
  PlanTest() {
    files::write_text(folder_ / "a.rawlog", "");
    files::write_text(folder_ / "b.rawlog", "");
    files::write_text(folder_ / "truth.tum", "");
  }

  Plan read(const std::string& yaml) const { return plan_of(folder_, yaml); }

  std::string message_of(const std::string& yaml) const {
    try {
      read(yaml);
    } catch (const files::InputError& error) {
      return error.what();
    }
    return "no error";
  }

  TemporaryFolder folder_;
};

TEST_F(PlanTest, FillsInWhatIsNotSaid) {
  const Plan plan = read(kSmall);
  ASSERT_EQ(plan.recordings.size(), 1U);
  EXPECT_EQ(plan.recordings[0].name, "a");
  EXPECT_EQ(plan.recordings[0].path, folder_ / "a.rawlog");
  EXPECT_EQ(plan.pipelines[0].name, "floam");
  EXPECT_EQ(plan.repeats, 1);
  EXPECT_EQ(plan.limits, RunLimits{});
  EXPECT_EQ(plan.metrics.front(), "ape_translation_rmse");
  EXPECT_EQ(describe(plan), "1 recording x 1 pipeline (1 with the grid) x 1 repeat = 1 run");
}

TEST_F(PlanTest, SpreadsGlobsSeedsAndGrids) {
  const Plan plan = read(
      "recordings:\n"
      "  - '*.rawlog'\n"
      "  - {simulate: street, arguments: {length: 12, quiet: true, loud: false}, seeds: [1, 2]}\n"
      "pipelines:\n"
      "  - floam\n"
      "  - preset: floam\n"
      "    name: vector\n"
      "    set: {solver: {line_residual: vector}}\n"
      "    grid: {map.radius_m: [60, 80]}\n"
      "grid: {solver.huber_m: [0.1, 0.2, 0.3]}\n"
      "repeats: 2\n");
  ASSERT_EQ(plan.recordings.size(), 4U);
  EXPECT_EQ(plan.recordings[1].name, "b");
  EXPECT_EQ(plan.recordings[3].name, "street-seed2");
  EXPECT_THAT(plan.recordings[3].generated->arguments,
              ElementsAre("--length", "12", "--quiet", "--seed", "2"));
  EXPECT_THAT(plan.pipelines[1].assignments, ElementsAre("solver.line_residual=vector"));
  EXPECT_EQ(grid_points(plan.pipelines[0].grid).size(), 3U);
  const auto points = grid_points(plan.pipelines[1].grid);
  ASSERT_EQ(points.size(), 6U);
  EXPECT_THAT(points[1], ElementsAre("solver.huber_m=0.1", "map.radius_m=80"));
  EXPECT_THAT(describe(plan), HasSubstr("= 72 runs"));
}

TEST_F(PlanTest, TakesPathsFromThePlansFolder) {
  const Plan plan = read(
      "recordings:\n  - {path: a.rawlog, name: first, reference: truth.tum, reference_frame: "
      "lidar, "
      "first: 2, last: 5, statements: {motion_compensated: true, lidar: {rings: 16}}}\n"
      "pipelines: [floam]\n");
  EXPECT_EQ(plan.recordings[0].reference, folder_ / "truth.tum");
  EXPECT_EQ(plan.recordings[0].last, 5);
  EXPECT_THAT(plan.recordings[0].statements,
              ElementsAre("motion_compensated=true", "lidar.rings=16"));
}

TEST_F(PlanTest, ReadsLimitsBudgetsMetricsAndSlurm) {
  const Plan plan = read(std::string(kSmall) +
                         "limits: {time_s: 10, memory_mb: 500, threads: 2}\n"
                         "budgets: {ape_translation_rmse: 0.2}\n"
                         "metrics: [mme, wall_s]\n"
                         "slurm: {runs_per_task: 4, options: {partition: fast, time: '01:00:00', "
                         "exclusive: true}}\n");
  EXPECT_EQ(plan.limits.memory_mb, 500);
  EXPECT_EQ(plan.budgets[0].most, 0.2);
  EXPECT_THAT(plan.metrics, ElementsAre("mme", "wall_s"));
  EXPECT_EQ(plan.slurm.runs_per_task, 4);
  EXPECT_THAT(plan.slurm.sbatch, ElementsAre("--partition=fast", "--time=01:00:00", "--exclusive"));
}

TEST_F(PlanTest, WrongPlansAreToldWithTheirLine) {
  struct Case {
    std::string yaml;
    int line;
    const char* part;
  };
  const std::string small = kSmall;
  for (const Case& c : {
           Case{small + "repets: 2\n", 3, "did you mean 'repeats'"},
           Case{small + "limits:\n  time: 3\n", 4, "limits.time"},
           Case{small + "limits:\n  time_s: -3\n", 4, "limits.time_s"},
           Case{small + "limits:\n  memory_mb: 1\n", 4, "limits.memory_mb"},
           Case{small + "repeats: many\n", 3, "a whole number"},
           Case{small + "metrics: [ape]\n", 3, "'ape'"},
           Case{small + "metrics: [mme, mme]\n", 3, "again"},
           Case{small + "budgets:\n  drift: 3\n", 4, "'drift'"},
           Case{small + "slurm:\n  options: {array: 3}\n", 4, "'array'"},
           Case{small + "grid:\n  solver.hubber_m: [1]\n", 4, "solver.hubber_m"},
           Case{small + "grid:\n  solver.huber_m: 0.1\n", 4, "a list of values"},
           Case{small + "grid:\n  solver.huber_m: [0.1, -1]\n", 4, "above 0"},
           Case{small + "grid:\n  solver.huber_m: [0.1, 0.1]\n", 4, "each value once"},
           Case{"recordings: [c.rawlog]\npipelines: [floam]\n", 1, "c.rawlog"},
           Case{"recordings:\n  - a.rawlog\n  - a.rawlog\npipelines: [floam]\n", 3, "'a' again"},
           Case{"recordings:\n  - path: a.rawlog\n    reference: no.tum\npipelines: [floam]\n", 3,
                "no.tum"},
           Case{"recordings:\n  - {path: a.rawlog, simulate: street}\npipelines: [floam]\n", 2,
                "both"},
           Case{"recordings:\n  - path: a.rawlog\n    seeds: [1]\npipelines: [floam]\n", 3,
                "'seeds'"},
           Case{"recordings:\n  - path: a.rawlog\n    first: 4\n    last: 3\npipelines: [floam]\n",
                4, "before"},
           Case{"recordings: []\npipelines: [floam]\n", 1, "at least one recording"},
           Case{"recordings: [a.rawlog]\n", 1, "at least one pipeline"},
           Case{"recordings: [a.rawlog]\npipelines: [none]\n", 2, "'none'"},
           Case{"recordings: [a.rawlog]\npipelines:\n  - floam\n  - floam\n", 4, "'floam' again"},
           Case{"recordings: [a.rawlog]\npipelines:\n  - {preset: floam, set: {x.y: 1}}\n", 3,
                "x.y"},
           Case{"recordings: [a.rawlog]\npipelines:\n  - preset: floam\n    config: [x.yaml]\n", 4,
                "x.yaml"},
           Case{"recordings: [a.rawlog]\npipelines:\n  - preset: floam\n    set: {solver.huber_m: "
                "1}\ngrid: {solver.huber_m: [1, 2]}\n",
                4, "does not vary"},
       }) {
    EXPECT_THAT(message_of(c.yaml), AllOf(HasSubstr("line " + std::to_string(c.line) + ":"),
                                          HasSubstr("plan.yaml"), HasSubstr(c.part)))
        << c.yaml;
  }
}

TEST_F(PlanTest, ASimulationThatWouldNotBeginIsToldWithItsLine) {
  files::write_text(
      folder_ / "plan.yaml",
      "recordings:\n  - {simulate: moon, arguments: {size: 3}}\npipelines: [floam]\n");
  std::vector<std::string> asked;
  try {
    load_plan(folder_ / "plan.yaml", TRAVERSE_SHARE_DIR, [&](const auto& words) {
      asked = words;
      return std::optional<std::string>("no such world");
    });
    FAIL();
  } catch (const files::InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("line 2"), HasSubstr("no such world")));
  }
  EXPECT_THAT(asked, ElementsAre("moon", "--size", "3"));
}

TEST_F(PlanTest, LimitsThatThisMachineCannotKeepAreToldWithTheirLine) {
  const auto error_of = [&](const std::string& limits) -> std::string {
    try {
      check_this_machine(read(kSmall + limits));
    } catch (const files::InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(error_of(""), "no error");
  EXPECT_THAT(error_of("limits:\n  threads: 256\n"), HasSubstr("line 4"));
  EXPECT_THAT(error_of("limits:\n  memory_mb: 1e7\n"), HasSubstr("line 4"));
}

TEST_F(PlanTest, RunsAreCountedBeforeTheirListIsMade) {
  std::string grid = "grid:\n";
  for (const char* key : {"solver.huber_m", "map.radius_m", "map.edge_voxel_m",
                          "map.planar_voxel_m", "thinning.edge_voxel_m", "thinning.planar_voxel_m",
                          "features.noise_m", "features.break_m"}) {
    grid += std::string("  ") + key + ": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n";
  }
  EXPECT_THAT(message_of(kSmall + grid),
              AllOf(HasSubstr("line 3: expected at most 200000 runs"),
                    HasSubstr("1 recording x 1 pipeline (100000000 with the grid) x 1 repeat = "
                              "100000000 runs")));

  Plan plan = read(kSmall);
  plan.pipelines[0].grid.assign(30, {"a", std::vector<std::string>(1000, "1"), {}});
  EXPECT_EQ(count_runs(plan), std::numeric_limits<std::size_t>::max());
  EXPECT_THAT(describe(plan), HasSubstr("more than can be counted runs"));
}

TEST(Plan, ARecipeIsACommandWithTheEntrysOwnKeysOverIt) {
  const testing::TemporaryFolder folder;
  files::write_text(folder / "drive.rawlog", "");
  const Plan plan = plan_of(folder,
                            "recordings: [drive.rawlog]\npipelines:\n  - system: kiss-icp\n"
                            "  - {system: kiss-icp, name: other, frame: body}\n");
  EXPECT_EQ(plan.pipelines[0].name, "KISS-ICP");
  EXPECT_EQ(plan.pipelines[0].command.frame, "lidar");
  EXPECT_EQ(plan.pipelines[1].name, "other");
  EXPECT_EQ(plan.pipelines[1].command.frame, "body");
  EXPECT_EQ(plan.pipelines[1].command.text, plan.pipelines[0].command.text);
  EXPECT_THAT(plan.pipelines[1].command.formats(), ::testing::ElementsAre("kitti"));
  try {
    plan_of(folder, "recordings: [drive.rawlog]\npipelines:\n  - system: nobodys\n");
    ADD_FAILURE();
  } catch (const files::InputError& error) {
    EXPECT_EQ(error.place().text, "line 3");
    EXPECT_THAT(error.expected(), ::testing::HasSubstr("a recipe of: kiss-icp"));
  }
}

/// What the installed plans for the field's data sets say without the data: all that is missing.
TEST(Plans, OfDataSetsAreReadAndNameWhatIsMissing) {
  const std::filesystem::path share = TRAVERSE_SHARE_DIR;
  for (const auto& [name, first, last] :
       {std::tuple{"kitti_odometry", "sequences/00", "sequences/10"},
        std::tuple{"mulran", "DCC01", "Sejong03"},
        std::tuple{"newer_college", "01_short_experiment", "07_parkland_mound"}}) {
    SCOPED_TRACE(name);
    const std::filesystem::path file = share / "batches" / (std::string(name) + ".yaml");
    const testing::TemporaryFolder folder;  // where the data are not
    std::filesystem::create_directories(folder / "share/batches");
    std::filesystem::create_directory_symlink(share / "recordings", folder / "share/recordings");
    std::filesystem::copy_file(file, folder / "share/batches/plan.yaml");
    try {
      load_plan(folder / "share/batches/plan.yaml", share, no_error);
      FAIL() << "the data are not there";
    } catch (const files::InputError& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr("that is there"), HasSubstr(first)));
      if (std::string(name) != "mulran") {
        EXPECT_THAT(error.what(), HasSubstr(last));
      }
    }
    const std::string text = files::read_text(file);  // and with data in those places
    std::size_t at = 0;
    std::size_t recordings = 0;
    while ((at = text.find("../../build/data/", at)) != std::string::npos) {
      const std::size_t end = text.find_first_of("\n}", at);
      const std::filesystem::path place = folder / "share/batches" / text.substr(at, end - at);
      const auto path = place.lexically_normal();
      if (path.extension() == ".csv") {
        std::filesystem::create_directories(path.parent_path());
        files::write_text(path, "");
      } else {
        std::filesystem::create_directories(path);
        ++recordings;
      }
      at = end;
    }
    const Plan plan = load_plan(folder / "share/batches/plan.yaml", share, no_error);
    EXPECT_EQ(plan.recordings.size(), recordings);
    EXPECT_EQ(plan.pipelines.size(), 3U);
  }
}

}  // namespace
}  // namespace traverse::batch
