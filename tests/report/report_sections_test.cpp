#include "sections/report_sections.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/pipeline/frame_table.hpp"
#include "traverse/pipeline/run_folder.hpp"
#include "traverse/report/run_report.hpp"

#include "made_run.hpp"
#include "temporary_folder.hpp"

namespace traverse::report {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Not;
using testing::TemporaryFolder;

/// What stands between `begin` and `end` wherever `begin` is found.
std::vector<std::string> all_between(const std::string& text, const std::string& begin,
                                     const std::string& end) {
  std::vector<std::string> found;
  for (std::size_t at = 0; (at = text.find(begin, at)) != std::string::npos;) {
    at += begin.size();
    found.push_back(text.substr(at, text.find(end, at) - at));
  }
  return found;
}

TEST(ReportSections, EachHasItsTemplateAndEachTemplateItsSection) {
  std::set<std::string> of_table;
  for (const ReportSection& section : report_sections()) {
    EXPECT_TRUE(of_table.insert(std::string(section.id) + ".html").second) << section.id;
  }
  std::set<std::string> of_folder;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(kTemplates) + "/run")) {
    of_folder.insert(entry.path().filename().string());
  }
  EXPECT_EQ(of_table, of_folder);
}

TEST(ReportSections, ContentsAndPageFollowTheTable) {
  const TemporaryFolder folder;
  MadeRunOptions options;
  options.with_reference = false;
  make_run(folder.path(), options);
  RunReportOptions quick;
  quick.pictures = false;
  write_run_report(folder.path(), kTemplates, quick);
  const std::string page = files::read_text(pipeline::RunFolder{folder.path()}.report());
  const auto sections = all_between(page, "<section id=\"", "\"");
  EXPECT_THAT(sections, ElementsAre("verdict", "trajectory", "worst", "map", "health", "timing",
                                    "configuration", "provenance"));
  const std::string contents = page.substr(0, page.find("</nav>"));
  EXPECT_EQ(all_between(contents, "<a href=\"#", "\""), sections);
  for (const ReportSection& section : report_sections()) {
    const std::string line = std::string(section.id) + "\">" + std::string(section.title) + "</a>";
    const bool is_there = std::find(sections.begin(), sections.end(), section.id) != sections.end();
    EXPECT_EQ(contents.find(line) != std::string::npos, is_there) << section.id;
  }
}

/// The folder's frames.csv with a covariance in each row: `variance` on its diagonal.
void give_covariances(const pipeline::RunFolder& files, double variance) {
  const pipeline::FrameTable before = pipeline::FrameTable::read_csv(files.frames());
  std::vector<std::string> columns = before.columns();
  const std::string last = columns.back();
  columns.pop_back();
  const std::vector<std::string> axes{"rx", "ry", "rz", "tx", "ty", "tz"};
  std::vector<double> values;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = i; j < 6; ++j) {
      columns.push_back("covariance_" + axes[i] + "_" + axes[j]);
      values.push_back(i == j ? variance : 0);
    }
  }
  columns.push_back(last);
  pipeline::FrameTable after(columns);
  for (std::size_t row = 0; row < before.column(last).size(); ++row) {
    std::vector<double> cells;
    for (const std::string& name : before.columns()) {
      if (name != last) cells.push_back(before.column(name)[row]);
    }
    cells.insert(cells.end(), values.begin(), values.end());
    cells.push_back(before.column(last)[row]);
    after.add_row(cells);
  }
  after.write_csv(files.frames());
}

TEST(ReportSections, EveryPictureAndChartHasItsPlaceOnThePage) {
  const TemporaryFolder folder;
  make_run(folder.path());
  give_covariances(pipeline::RunFolder{folder.path()}, 100);
  RunReportOptions options;
  options.picture_width = 480;
  write_run_report(folder.path(), kTemplates, options);
  const pipeline::RunFolder files{folder.path()};
  const std::string page = files::read_text(files.report());
  const Json json = Json::parse(files::read_text(files.report_json()));
  const auto figures = all_between(page, "<figure id=\"", "\"");
  ASSERT_GT(json.at("pictures").size(), 8U);
  for (const Json& picture : json.at("pictures")) {
    EXPECT_THAT(figures, Contains(picture.at("name").get<std::string>()));
  }
  const auto places = all_between(page, "data-charts=\"", "\"");
  ASSERT_GT(json.at("charts").size(), 8U);
  for (const Json& chart : json.at("charts")) {
    EXPECT_THAT(places, Contains(chart.at("section").get<std::string>()));
  }

  // The error of the path is drawn within the run's own bounds.
  const auto& charts = json.at("charts");
  const auto chart = std::find_if(charts.begin(), charts.end(),
                                  [](const Json& one) { return one.at("id") == "pose-bounds"; });
  ASSERT_NE(chart, charts.end());
  EXPECT_NE(chart->at("title").get<std::string>().find("100.0 % of the poses"), std::string::npos);
  ASSERT_EQ(chart->at("series").size(), 3U);
  for (const Json& series : chart->at("series")) {
    EXPECT_NEAR(series.at("band").at(std::size_t{30}).get<double>(), 19.6, 1e-6);
  }
}

TEST(ReportSections, CovariancesThatLackAnEntryAreRefused) {
  const TemporaryFolder folder;
  make_run(folder.path());
  const pipeline::RunFolder files{folder.path()};
  give_covariances(files, 1);
  std::string text = files::read_text(files.frames());
  text.replace(text.find("covariance_tx_tz"), 16, "covariance_tx_tt");
  files::write_text(files.frames(), text);
  EXPECT_THROW(write_run_report(folder.path(), kTemplates, RunReportOptions{}), files::InputError);
}

}  // namespace
}  // namespace traverse::report
