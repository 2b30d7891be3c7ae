#include <filesystem>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/files/text_file.hpp"

#include "end_to_end/program.hpp"
#include "temporary_folder.hpp"

namespace traverse {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramResult;
using testing::run_program;
using testing::TemporaryFolder;

json read_json(const std::filesystem::path& file) { return json::parse(files::read_text(file)); }

TEST(CheckJacobians, EveryFactorOfTraversePasses) {
  const TemporaryFolder folder;
  const ProgramResult result = run_program("check-jacobians --states 50 --seed 3 --json " +
                                           (folder / "audit.json").string());
  EXPECT_EQ(result.status, 0) << result.messages;
  EXPECT_THAT(result.output, AllOf(ContainsRegex("line vector +right +rotation .* pass"),
                                   ContainsRegex("swept plane absolute +left +translation .* pass"),
                                   HasSubstr("PASS: all within"), Not(HasSubstr("FAIL"))));
  const json audit = read_json(folder / "audit.json");
  EXPECT_EQ(audit["passed"], true);
  EXPECT_EQ(audit["states"], 50);
  EXPECT_EQ(audit["seed"], 3);
  for (const json& factor : audit["factors"]) {
    EXPECT_GT(factor["min_residual"], 0.1);
    for (const json& block : factor["blocks"]) {
      EXPECT_LT(block["automatic"]["relative"], audit["tolerance"]["automatic"]);
      EXPECT_LT(block["numeric"]["relative"], audit["tolerance"]["numeric"]);
    }
  }
}

/// The exercise's fourteen blocks, analytic beside numeric.
TEST(CheckJacobians, ShowsTheBlocksOfThePreintegrationByTheBooksNames) {
  const ProgramResult result = run_program("check-jacobians --factor inertial --show");
  EXPECT_EQ(result.status, 0) << result.messages;
  std::size_t before = 0;
  for (const char* name :
       {"dR/dR1", "dR/dbg1", "dR/dR2", "dv/dR1", "dv/dv1", "dv/dbg1", "dv/dba1", "dv/dv2", "dp/dR1",
        "dp/dp1", "dp/dv1", "dp/dbg1", "dp/dba1", "dp/dp2"}) {
    const std::size_t at = result.output.find(std::string(name) + ": analytic | automatic");
    ASSERT_NE(at, std::string::npos) << name;
    EXPECT_GT(at + 1, before) << name;
    before = at;
    const std::string most = "(at most ";
    const std::size_t figure = result.output.find(most, at) + most.size();
    EXPECT_LT(std::stod(result.output.substr(figure)), 1e-6) << name;
  }
  const ProgramResult lidar = run_program("check-jacobians --factor lidar --show");
  for (const char* name : {"line vector", "line scalar", "plane absolute", "plane signed"}) {
    EXPECT_THAT(lidar.output, HasSubstr(std::string(name) + ", right perturbation"));
  }
  const ProgramResult none = run_program("check-jacobians --factor lines");
  EXPECT_EQ(none.status, 1);
  EXPECT_THAT(none.messages, HasSubstr("no factor is called 'lines'"));
}

TEST(CheckJacobians, ABrokenFactorFailsAndIsNamed) {
  const TemporaryFolder folder;
  const ProgramResult result = run_program("check-jacobians --json " + (folder / "a.json").string(),
                                           TRAVERSE_BROKEN_PROGRAM);
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.output, AllOf(ContainsRegex("turned point +right +rotation .* FAIL"),
                                   ContainsRegex("\nFAIL\n"), Not(HasSubstr("PASS"))));
  EXPECT_THAT(result.messages, HasSubstr("turned point, right perturbation, rotation: off by"));
  EXPECT_EQ(read_json(folder / "a.json")["passed"], false) << "written all the same";
}

TEST(CheckJacobians, WrongUsageIsTwo) {
  EXPECT_EQ(run_program("check-jacobians --states 0").status, 2);
  EXPECT_EQ(run_program("check-jacobians --states many").status, 2);
  EXPECT_EQ(run_program("check-jacobians --json /no/such/folder/a.json").status, 1);
  EXPECT_EQ(run_program("check-jacobians --help").status, 0);
}

TEST(BenchFactors, MeasuresEveryFactorAndEveryDerivativeOnASimulatedFrame) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_program("bench-factors --frame 3 --repeats 5 --json " + (folder / "b.json").string());
  ASSERT_EQ(result.status, 0) << result.messages;
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("simulated street, frame 3"), ContainsRegex("line vector .* ± "),
                    ContainsRegex("swept line scalar \\+ swept plane signed .*")));
  const json bench = read_json(folder / "b.json");
  EXPECT_EQ(bench["repeats"], 5);
  EXPECT_EQ(bench["evaluations"].size(), 24U);  // 4 residuals, deskewed and swept, 3 derivatives
  EXPECT_EQ(bench["solves"].size(), 12U);       // 2 line forms, deskewed and swept, 3 derivatives
  for (const json& cost : bench["evaluations"]) {
    const json& ns = cost["nanoseconds"];
    EXPECT_GT(cost["residuals"], 50);
    EXPECT_GT(ns["lower_quartile"], 0);
    EXPECT_LE(ns["lower_quartile"], ns["median"]);
    EXPECT_LE(ns["median"], ns["upper_quartile"]);
  }
  for (const json& cost : bench["solves"]) {
    EXPECT_GT(cost["iterations"], 0);
    EXPECT_LT(cost["from_analytic_m"], 1e-6) << cost;
    EXPECT_LT(cost["from_analytic_rad"], 1e-8) << cost;
  }
}

TEST(BenchFactors, IsAPartOfARunAndOfItsReportWhenAskedFor) {
  const TemporaryFolder folder;
  const std::string street = (folder / "street.rawlog").string();
  const std::string run = (folder / "run").string();
  ASSERT_EQ(run_program("simulate town_short --sensor vlp16 --first 80 --duration 0.5 -o " + street)
                .status,
            0);
  const ProgramResult result =
      run_program("run " + street + " -o " + run +
                  " --pipeline floam --set solver.perturbation=left --bench-factors");
  ASSERT_EQ(result.status, 0) << result.messages;
  const json bench = read_json(folder / "run/factor_bench.json");
  EXPECT_EQ(bench["frame"], 4);
  EXPECT_EQ(bench["recording"], "Short town drive (VLP-16)");
  const json audit = read_json(folder / "run/jacobians.json");
  ASSERT_EQ(audit["factors"].size(), 2U) << "those that the run used";
  EXPECT_EQ(audit["factors"][0]["factor"], "line scalar");
  EXPECT_EQ(audit["factors"][1]["factor"], "plane signed");
  for (const json& factor : audit["factors"]) EXPECT_EQ(factor["perturbation"], "left");
  EXPECT_THAT(files::read_text(folder / "run/report.html"),
              AllOf(HasSubstr("id=\"jacobians\""), HasSubstr("id=\"derivatives\"")));

  ASSERT_EQ(run_program("run " + street + " -o " + run + " --pipeline floam --no-hash --no-report")
                .status,
            0);
  EXPECT_FALSE(std::filesystem::exists(folder / "run/factor_bench.json")) << "of the earlier run";
  EXPECT_TRUE(std::filesystem::exists(folder / "run/jacobians.json"));
}

TEST(BenchFactors, TellsWhatItCannotMeasure) {
  const TemporaryFolder folder;
  const std::string street = (folder / "street.rawlog").string();
  ASSERT_EQ(run_program("simulate town_short --first 80 --duration 0.3 -o " + street).status, 0);
  const ProgramResult result = run_program("bench-factors " + street + " --frame 9");
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.messages, HasSubstr("frame 9 is asked for, but the recording has only 3"));
  EXPECT_EQ(run_program("bench-factors --frame 0").status, 2);
  EXPECT_EQ(run_program("bench-factors --repeats 0").status, 2);
  EXPECT_EQ(run_program("bench-factors " + (folder / "nothing").string()).status, 1);
}

TEST(SolverChoices, EveryDerivativeAndPerturbationRunsToTheSameTrajectory) {
  const TemporaryFolder folder;
  const std::string street = (folder / "street.rawlog").string();
  ASSERT_EQ(run_program("simulate town_short --first 80 --duration 0.4 -o " + street).status, 0);
  std::optional<geometry::Trajectory> first;
  for (const std::string choice :
       {"analytic --set solver.perturbation=right", "automatic --set solver.perturbation=left",
        "numeric --set solver.plane_residual=absolute"}) {
    const ProgramResult result =
        run_program("run " + street + " -o " + (folder / "r").string() +
                    " --pipeline floam --no-report --no-hash --set start.scans=0 "
                    "--set solver.derivative=" +
                    choice);
    ASSERT_EQ(result.status, 0) << result.messages;
    const auto trajectory =
        dataset::read_trajectory(folder / "r/trajectory.tum", dataset::TrajectoryFormat::kTum);
    ASSERT_EQ(trajectory.size(), 4U);
    if (!first) first = trajectory;
    for (std::size_t i = 0; i < trajectory.size(); ++i) {
      const geometry::Pose3 apart = first->pose(i).inverse() * trajectory.pose(i);
      EXPECT_LT(apart.translation.norm(), 1e-5) << choice;
    }
  }
}

}  // namespace
}  // namespace traverse
