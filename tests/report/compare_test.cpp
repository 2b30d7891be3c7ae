#include "traverse/report/compare.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"

#include "comparison/comparison.hpp"
#include "made_run.hpp"
#include "temporary_folder.hpp"

namespace traverse::report {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Judge, NeedsTheWholeIntervalBeyondTheThreshold) {
  EXPECT_EQ(judge({-3, -2}, 1), Change::kImproved);
  EXPECT_EQ(judge({-3, -0.5}, 1), Change::kNoChange);
  EXPECT_EQ(judge({-0.5, 0.5}, 1), Change::kNoChange);
  EXPECT_EQ(judge({2, 3}, 1), Change::kRegressed);
  EXPECT_EQ(judge({0.5, 3}, 1), Change::kNoChange);
}

class Compare : public ::testing::Test {
 protected:
  std::filesystem::path run(const std::string& name, double error_m, bool with_reference = true,
                            const std::string& recording = kEvil) {
    MadeRunOptions options;
    options.error_m = error_m;
    options.with_reference = with_reference;
    options.name = recording;
    std::filesystem::create_directories(folder / name);
    make_run(folder / name, options);
    return folder / name;
  }
  std::string compare(const std::vector<std::filesystem::path>& runs) {
    return write_comparison(runs, folder / "compare.html", kTemplates);
  }
  Json json() const { return Json::parse(files::read_text(folder / "compare.json")); }
  /// The cell of the row that begins with these.
  Json verdict(const std::string& name, const std::string& figure) const {
    const Json all = json();
    for (const Json& row : all["tables"]["differences"]["rows"]) {
      if (row[0] == name && row[1] == figure) return row.back();
    }
    return nullptr;
  }

  testing::TemporaryFolder folder;
};

TEST_F(Compare, TellsWhatIsBetterAndWhatIsTheSame) {
  const std::string table = compare({run("bad", 1.0), run("good", 0.1), run("same", 1.0)});
  EXPECT_EQ(verdict("good", "RPE over 10 frames"), "improved");
  EXPECT_EQ(verdict("same", "RPE over 10 frames"), "no change");
  EXPECT_EQ(verdict("good", "Time per frame"), "no change");
  EXPECT_THAT(table, HasSubstr("good: 3 improved; same: nothing changed."));
  EXPECT_EQ(json()["tables"]["wins"]["rows"][0][1], 0);  // the bad one is best nowhere
}

TEST_F(Compare, TheOtherWayRoundItHasRegressed) {
  EXPECT_THAT(compare({run("good", 0.1), run("bad", 1.0)}),
              ContainsRegex("bad: [0-9] regressed [(].*RPE over 10 frames"));
  EXPECT_EQ(verdict("bad", "RPE over 10 frames"), "regressed");
  EXPECT_GT(json()["tables"]["wins"]["rows"][0][1], 10);
}

TEST_F(Compare, WithoutAReferenceTimesAreCompared) {
  compare({run("a", 0.1, false), run("b", 0.1, false)});
  EXPECT_EQ(verdict("b", "Time per frame"), "no change");
  EXPECT_EQ(verdict("b", "APE"), nullptr);
}

TEST_F(Compare, ThePageShowsUntrustedTextAndHoldsTheJson) {
  compare({run("<b>a", 0.1), run("b", 0.1)});
  const std::string page = files::read_text(folder / "compare.html");
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, Not(HasSubstr("<b>a")));
  EXPECT_THAT(page, HasSubstr(files::read_text(folder / "compare.json").substr(0, 3000)));
}

TEST_F(Compare, RefusesRunsOfDifferentRecordingsAndASingleRun) {
  EXPECT_THROW(compare({run("a", 0.1, true, "one"), run("b", 0.1, true, "other")}),
               files::InputError);
  EXPECT_THROW(compare({run("a", 0.1)}), std::invalid_argument);
}

}  // namespace
}  // namespace traverse::report
