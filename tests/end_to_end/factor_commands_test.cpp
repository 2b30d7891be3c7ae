#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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
    EXPECT_GT(factor["least_residual"], 0.1);
    for (const json& block : factor["blocks"]) {
      EXPECT_LT(block["automatic"]["relative"], audit["tolerance"]["automatic"]);
      EXPECT_LT(block["numeric"]["relative"], audit["tolerance"]["numeric"]);
    }
  }
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

}  // namespace
}  // namespace traverse
