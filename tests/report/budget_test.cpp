#include "traverse/report/budget.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"

#include "made_run.hpp"
#include "temporary_folder.hpp"

namespace traverse::report {
namespace {

using ::testing::HasSubstr;

class Budget : public ::testing::Test {
 protected:
  Budget() { make_run(folder.path()); }

  BudgetResult check(const std::string& yaml) const {
    files::write_text(folder / "budget.yaml", yaml);
    return check_budget(folder / "budget.yaml", folder.path());
  }

  testing::TemporaryFolder folder;
};

TEST_F(Budget, IsKeptWhenEveryFigureIsAtMostItsLimit) {
  const BudgetResult result = check("ape_rmse_m: 1\nskipped_records: 1\n");
  EXPECT_TRUE(result.passed());
  EXPECT_THAT(result.table(), HasSubstr("pass  ape_rmse_m"));
  EXPECT_THAT(result.table(), HasSubstr("kept"));
}

TEST_F(Budget, IsNotKeptWhenOneIsAbove) {
  const BudgetResult result = check("ape_rmse_m: 0.0001\nskipped_records: 1\n");
  EXPECT_FALSE(result.passed());
  EXPECT_THAT(result.table(), HasSubstr("FAIL  ape_rmse_m"));
  EXPECT_THAT(result.table(), HasSubstr("1 of 2 limits not kept"));
}

TEST_F(Budget, AFigureThatIsNotDefinedKeepsNoLimit) {
  EXPECT_FALSE(check("map_entropy_nats: 100\n").passed());  // the made run has no score
}

TEST_F(Budget, OfWhatIsBetterWhenItIsMoreIsTheLeast) {
  EXPECT_TRUE(check("registered_share: 1\n").passed());
  EXPECT_THAT(check("registered_share: 1\n").table(), HasSubstr("1.00 at least 1.00"));
  EXPECT_FALSE(check("registered_share: 1.01\n").passed());
  EXPECT_TRUE(check("restarts: 0\nlost_frames: 0\n").passed());
}

TEST_F(Budget, TakesTheFormerNamesOfTheClosingError) {
  const BudgetResult result = check("end_drift_percent: 5\nend_error_m: 1e-9\n");
  ASSERT_EQ(result.lines.size(), 2U);
  EXPECT_EQ(result.lines[0].figure, "closing_error_m");
  EXPECT_EQ(result.lines[1].figure, "closing_error_percent");
  EXPECT_FALSE(result.lines[0].passed());
  EXPECT_TRUE(result.lines[1].passed());
}

TEST_F(Budget, RefusesUnknownFiguresAndEmptyBudgets) {
  EXPECT_THROW(check("ape_rmse: 1\n"), files::InputError);
  EXPECT_THROW(check("{}\n"), files::InputError);
}

TEST(ShippedBudgets, AreValid) {
  for (const auto& file : std::filesystem::directory_iterator(TRAVERSE_SHARE_DIR "/budgets")) {
    EXPECT_NO_THROW(require_valid_budget(file.path())) << file.path();
  }
}

}  // namespace
}  // namespace traverse::report
