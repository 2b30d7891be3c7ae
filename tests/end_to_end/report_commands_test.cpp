#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"

#include "program.hpp"
#include "report/made_run.hpp"

namespace traverse {
namespace {

using ::testing::HasSubstr;
using testing::run_program;

class ReportCommands : public ::testing::Test {
 protected:
  ReportCommands() {
    for (const char* name : {"one", "two"}) {
      std::filesystem::create_directories(folder / name);
      report::MadeRunOptions options;
      options.error_m = std::string(name) == "one" ? 1.0 : 0.1;
      report::make_run(folder / name, options);
    }
    files::write_text(folder / "loose.yaml", "ape_rmse_m: 10\n");
    files::write_text(folder / "tight.yaml", "ape_rmse_m: 0.001\n");
    files::write_text(folder / "wrong.yaml", "ape_rsme_m: 1\n");
  }
  std::string at(const std::string& name) const { return (folder / name).string(); }

  testing::TemporaryFolder folder;
};

TEST_F(ReportCommands, ABudgetThatIsNotKeptIsAFailure) {
  const std::string report = "report --no-pictures " + at("one") + " --budget ";
  const auto kept = run_program(report + at("loose.yaml"));
  EXPECT_EQ(kept.status, 0) << kept.everything();
  EXPECT_THAT(kept.output, HasSubstr("pass  ape_rmse_m"));
  const auto broken = run_program(report + at("tight.yaml"));
  EXPECT_EQ(broken.status, 1);
  EXPECT_THAT(broken.output, HasSubstr("FAIL  ape_rmse_m"));
  EXPECT_THAT(files::read_text(folder / "one/report.html"), HasSubstr("fail"));
  const auto unknown = run_program(report + at("wrong.yaml"));
  EXPECT_EQ(unknown.status, 1);
  EXPECT_THAT(unknown.messages, HasSubstr("ape_rsme_m"));
}

TEST_F(ReportCommands, EvaluateKeepsBudgetsToo) {
  const std::string evaluate = "evaluate " + at("one") + " --align se3 --budget ";
  EXPECT_EQ(run_program(evaluate + at("loose.yaml")).status, 0);
  EXPECT_EQ(run_program(evaluate + at("tight.yaml")).status, 1);
}

TEST_F(ReportCommands, ExportsEveryTable) {
  const auto result = run_program("report --no-pictures " + at("one") + " --export " + at("out"));
  EXPECT_EQ(result.status, 0) << result.everything();
  for (const char* name : {"ape", "rpe", "timing", "configuration", "worst_segments", "made"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / (std::string(name) + ".csv"))) << name;
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / (std::string(name) + ".tex"))) << name;
  }
}

TEST_F(ReportCommands, CompareTellsWhatHasImproved) {
  const auto result =
      run_program("compare " + at("one") + " " + at("two") + " -o " + at("both.html"));
  EXPECT_EQ(result.status, 0) << result.everything();
  EXPECT_THAT(result.output, HasSubstr("two: 3 improved (APE; APE, angle; RPE over 10 frames)."));
  EXPECT_TRUE(std::filesystem::exists(folder / "both.html"));
  EXPECT_TRUE(std::filesystem::exists(folder / "both.json"));
  EXPECT_EQ(run_program("compare " + at("one")).status, 2);
  EXPECT_EQ(run_program("compare " + at("one") + " " + at("two") + " -o both.txt").status, 2);
}

}  // namespace
}  // namespace traverse
