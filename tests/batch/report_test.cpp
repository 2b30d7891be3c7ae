#include "results/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "batch/made_plan.hpp"
#include "results/report_data.hpp"

namespace traverse::batch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

struct Made {
  Plan plan;
  Results results{{made_job("a", "floam"), made_job("b", "floam"), made_job("b", "other")}};
  std::vector<VariantSummary> variants;
  std::optional<BaselineComparison> baseline;
  std::vector<ShownTable> tables;
  std::vector<Lead> leads;

  Made() {
    plan.file = "/plans/night.yaml";
    plan.text = "recordings: <all>\n";
    plan.metrics = {"ape_translation_rmse", "mme"};
    plan.recordings.resize(2);
    plan.recordings[0].name = "a";
    plan.recordings[1].name = "b";
    plan.pipelines.resize(2);
    plan.pipelines[0].name = "floam";
    plan.pipelines[1].name = "other";
    results.add(made_completion(results.jobs()[0], {{"ape_translation_rmse", 0.25}}));
    Completion bad = made_completion(results.jobs()[1], {}, Outcome::kFailed);
    bad.reason = "no scan </script> in \"b\"";
    bad.last_lines = {"floam: 3 frames", "traverse: no scan"};
    results.add(bad);
    variants = summarise(results, plan.budgets, plan.metrics.front());
  }
  ReportData data() const {
    return {plan, results, variants, baseline, tables, leads, {"traverse", "batch"}};
  }
};

TEST(BatchReport, CarriesTheNumbersOfEveryRun) {
  const Made made;
  const auto json = nlohmann::json::parse(report_data_json(made.data(), std::nullopt));
  EXPECT_EQ(json["recordings"], nlohmann::json({"a", "b"}));
  ASSERT_EQ(json["runs"].size(), 3U);
  EXPECT_EQ(json["runs"][0]["values"], nlohmann::json({0.25, nullptr}));
  EXPECT_EQ(json["runs"][1]["outcome"], "failed");
  EXPECT_TRUE(json["runs"][2]["outcome"].is_null());
  EXPECT_EQ(json["variants"][0]["name"], "floam");
}

TEST(BatchReport, SaysFirstHowItWentAndWhatFailed) {
  const Made made;
  const std::string whole =
      batch_page(made.data(), std::string(TRAVERSE_SOURCE_DIR) + "/reports/templates");
  const std::string page = whole.substr(0, whole.find("</main>"));  // without the scripts
  EXPECT_THAT(page, AllOf(HasSubstr("<h1>1 of 3 runs ok"), HasSubstr("failed: 1 run"),
                          HasSubstr("traverse: no scan"), HasSubstr("1 of 3 runs are not made")));
  EXPECT_THAT(whole, Not(HasSubstr("no scan </script>")));
  EXPECT_THAT(
      page, AllOf(Not(HasSubstr("<all>")), Not(HasSubstr("http://")), Not(HasSubstr("https://"))));
}

TEST(BatchReport, ShowsTheBestByEachMetric) {
  Made made;
  Lead lead;
  lead.metric = "ape_translation_rmse";
  lead.first = "floam";
  lead.second = "other";
  lead.mean = 0.25;
  lead.difference = 0.125;
  lead.interval = std::pair(0.05, 0.2);
  lead.better_on = 9;
  lead.recordings = 10;
  made.leads = {lead};
  const std::string page =
      batch_page(made.data(), std::string(TRAVERSE_SOURCE_DIR) + "/reports/templates");
  EXPECT_THAT(page, AllOf(HasSubstr("floam leads with 0.25 m APE"), HasSubstr("id=\"leads\""),
                          HasSubstr("9 of 10 recordings"), HasSubstr("0.05 to 0.2")));
}

}  // namespace
}  // namespace traverse::batch
