#include "page/page.hpp"

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/optimization/jacobian_audit.hpp"
#include "traverse/pipeline/run_folder.hpp"
#include "traverse/report/run_report.hpp"

#include "figures/run_figures.hpp"
#include "made_run.hpp"
#include "run/number_texts.hpp"
#include "run/report_model.hpp"
#include "run/run_data.hpp"
#include "temporary_folder.hpp"

namespace traverse::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::TemporaryFolder;

/// A made run in a folder of its own, and its report.
class MadeRun {
 public:
  explicit MadeRun(double error_m, bool with_reference = true) {
    MadeRunOptions options;
    options.error_m = error_m;
    options.with_reference = with_reference;
    make_run(folder.path(), options);
  }

  ReportModel model() const {
    const RunData run = read_run(folder.path(), pipeline::RunPart::kAll);
    const auto worst =
        evaluation::worst_segments(run.evaluation, run.frames.column("residual_rms_m"));
    const std::vector<RunFigure> figures = run_figures(run);
    return make_model({run, figures, worst});
  }
  std::string page() const {
    ReportModel report = model();
    return make_page(report, {}, kTemplates);
  }

  TemporaryFolder folder;
};

/// The page without the scripts that Traverse itself puts there, which may name tags and addresses.
std::string without_scripts(const std::string& page) {
  const auto first = page.find("</main>");
  return page.substr(0, first);
}

TEST(Page, ShowsUntrustedTextAndNeverRunsIt) {
  const std::string page = MadeRun(0.1).page();
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page,
              HasSubstr("&lt;script&gt;alert(&apos;x&apos;)&lt;/script&gt; &amp; &quot;quoted"));
}

TEST(Page, AsksTheNetworkForNothing) {
  const std::string page = without_scripts(MadeRun(0.1).page());
  const std::regex reference(R"((?:src|href|srcset|url)\s*[=(]\s*["']?([^"'\s)>]*))");
  for (std::sregex_iterator match(page.begin(), page.end(), reference), end; match != end;
       ++match) {
    const std::string target = (*match)[1];
    EXPECT_TRUE(target.starts_with("#") || target.starts_with("data:")) << target.substr(0, 80);
  }
}

/// The version that a library of the page tells after `key`.
std::string version_of(const std::string& code, const std::string& key) {
  const std::size_t begin = code.find(key + "=\"") + key.size() + 2;
  return code.substr(begin, code.find('"', begin) - begin);
}

TEST(Page, HoldsTheNoticesOfItsLibrariesAndTheirVersions) {
  const std::string with_scripts = MadeRun(0.1).page();
  const std::string page = without_scripts(with_scripts);
  EXPECT_THAT(page, HasSubstr("three.js r" + version_of(with_scripts, "REVISION") + ","));
  EXPECT_THAT(page, HasSubstr("dygraphs " + version_of(with_scripts, "VERSION") + ","));
  EXPECT_THAT(page, HasSubstr("three.js authors\n"));
  EXPECT_THAT(page, HasSubstr("Dan Vanderkam"));
  std::size_t notices = 0;
  for (std::size_t at = 0; (at = page.find("<pre>", at)) != std::string::npos; ++at) {
    const std::string notice = page.substr(at, page.find("</pre>", at) - at);
    const bool whole =
        notice.find("Permission is hereby granted, free of charge") != std::string::npos &&
        notice.find("WITHOUT WARRANTY OF ANY KIND") != std::string::npos;
    if (whole) ++notices;
  }
  EXPECT_EQ(notices, 2U);
}

/// What stands between `begin` and `end` after `from`, which is moved behind it.
std::string between(const std::string& text, const std::string& begin, const std::string& end,
                    std::size_t& from) {
  const auto first = text.find(begin, from);
  if (first == std::string::npos) return {};
  const auto last = text.find(end, first + begin.size());
  from = last + end.size();
  return text.substr(first + begin.size(), last - first - begin.size());
}

TEST(Page, EveryNumberIsThatOfTheJson) {
  const MadeRun run(0.1);
  const std::string page = run.page();
  std::size_t at = 0;
  const Json json = Json::parse(
      between(page, R"(<script type="application/json" id="report-data">)", "</script>", at));

  at = 0;
  std::size_t tables = 0;
  std::size_t numbers = 0;
  for (std::string html; !(html = between(page, "<table data-table=", "</table>", at)).empty();
       ++tables) {
    const std::string id = html.substr(1, html.find('"', 1) - 1);
    const Json& table = json.at("tables").at(id);
    std::size_t in_html = html.find("<tbody>");
    for (const Json& row : table.at("rows")) {
      std::size_t in_row = 0;
      const std::string row_html = between(html, "<tr", "</tr>", in_html);
      for (const Json& value : row) {
        const std::string cell = between(row_html, "<td", "</td>", in_row);
        if (!value.is_number()) continue;
        std::size_t in_cell = 0;
        EXPECT_EQ(files::parse_double(between(cell, "title=\"", "\"", in_cell)),
                  value.get<double>())
            << id;
        const std::string shown = cell.substr(cell.find('>') + 1);
        EXPECT_EQ(shown, value.is_number_integer() ? count_text(value.get<std::size_t>())
                                                   : short_number(value.get<double>()))
            << id;
        ++numbers;
      }
    }
    EXPECT_EQ(between(html, "<tr", "</tr>", in_html), "") << id << ": more rows than the JSON has";
  }
  EXPECT_GT(tables, 10U);
  EXPECT_GT(numbers, 200U);

  at = 0;
  std::size_t headlines = 0;
  for (std::string html; !(html = between(page, "<div data-figure=", "</div>", at)).empty();
       ++headlines) {
    const Json& figure = json.at("figures").at(html.substr(1, html.find('"', 1) - 1));
    const auto value = figure.at("value").get<double>();
    EXPECT_THAT(html, HasSubstr("title=\"" + full_number(value) + "\">" + short_number(value)));
    EXPECT_THAT(html, HasSubstr(figure.at("label").get<std::string>()));
    if (figure.at("interval").is_null()) continue;
    const Json& interval = figure.at("interval");
    EXPECT_THAT(html, HasSubstr(full_number(interval.at("low")) + " to " +
                                full_number(interval.at("high"))));
  }
  EXPECT_EQ(headlines, 6U);
  EXPECT_THAT(page, HasSubstr("<h1>" + json.at("verdict").get<std::string>() + "</h1>"));
}

TEST(ReportJson, AgreesWithEvaluationAndFrames) {
  const MadeRun run(0.1);
  const RunData data = read_run(run.folder.path(), pipeline::RunPart::kAll);
  const Json json = run.model().model.json;
  const auto& ape = data.evaluation.comparison->ape.front();
  EXPECT_EQ(json["figures"]["ape_rmse_m"]["value"], ape.statistics.rmse);
  EXPECT_EQ(json["figures"]["frame_median_ms"]["value"],
            data.record["timing_ms"]["frame_median"].get<double>());
  const auto chart = std::find_if(json["charts"].begin(), json["charts"].end(),
                                  [](const Json& item) { return item["id"] == "ape"; });
  ASSERT_NE(chart, json["charts"].end());
  ASSERT_EQ((*chart)["series"][0]["values"].size(), ape.values.size());
  for (std::size_t i = 0; i < ape.values.size(); ++i) {
    const double value = (*chart)["series"][0]["values"][i];
    EXPECT_NEAR(value, ape.values[i], 1e-8 * ape.values[i]);
  }
  // The estimate goes wrong around frame 40.
  const std::size_t first =
      std::stoul(json["tables"]["worst_segments"]["rows"][0][0].get<std::string>());
  EXPECT_GT(first, 25U);
  EXPECT_LT(first, 55U);
}

TEST(Page, NumbersAreThoseOfTheEvaluation) {
  const MadeRun run(0.1);
  const RunData data = read_run(run.folder.path(), pipeline::RunPart::kAll);
  const auto& ape = data.evaluation.comparison->ape.front().statistics;
  const std::string page = run.page();
  for (const double value : {ape.rmse, ape.mean, ape.median, ape.std, ape.max}) {
    EXPECT_THAT(page, HasSubstr("title=\"" + nlohmann::json(value).dump() + "\""));
  }
}

TEST(Page, TellsWhatIsNotAsItShouldBe) {
  const std::string page = MadeRun(0.1).page();
  EXPECT_THAT(page, HasSubstr("5 of 60 frames do not determine every direction"));
  EXPECT_THAT(page, HasSubstr("1 record skipped"));
  EXPECT_THAT(page, HasSubstr("with 1 of its settings changed"));
}

TEST(Page, CarriesTheCheckOfTheJacobians) {
  const MadeRun run(0.1);
  EXPECT_THAT(run.page(), Not(HasSubstr("id=\"factors\"")));
  optimization::FactorAudit factor;
  factor.factor = "line vector";
  factor.blocks = {{"rotation", 27, {1e-14, 1e-15, 3}, {1, 0.5, 4}, false}};
  const pipeline::RunFolder files{run.folder.path()};
  files::write_text(files.jacobians(), optimization::to_json({{}, {factor}}));
  const std::string page = run.page();
  EXPECT_THAT(page, HasSubstr("id=\"jacobians\""));
  EXPECT_THAT(page, HasSubstr("<td>FAIL</td>"));
  EXPECT_THAT(page, HasSubstr("A factor of this run has a wrong derivative")) << "in the verdict";
}

TEST(Page, WithoutAReferenceThereIsNoErrorSection) {
  const std::string page = MadeRun(0.1, false).page();
  EXPECT_THAT(page, HasSubstr("no reference to compare with"));
  EXPECT_THAT(page, Not(HasSubstr("id=\"error\"")));
}

TEST(RunReport, WritesPicturesAndOnePage) {
  const MadeRun run(0.1);
  write_run_report(run.folder.path(), kTemplates);
  const pipeline::RunFolder files{run.folder.path()};
  EXPECT_TRUE(std::filesystem::exists(files.images() / "trajectory-above.png"));
  EXPECT_TRUE(std::filesystem::exists(files.images() / "error-over-time_dark.png"));
  EXPECT_THAT(files::read_text(files.report()), HasSubstr("data:image/png;base64,iVBOR"));
  EXPECT_TRUE(std::filesystem::exists(files.images() / "error-over-time.pdf"));
  EXPECT_THAT(files::read_text(files.images() / "error-over-time.svg"), HasSubstr("<svg"));
  // The twin that stands in the page is the file.
  EXPECT_THAT(files::read_text(files.report()),
              HasSubstr(files::read_text(files.report_json()).substr(0, 5000)));
}

TEST(RunReport, DrawsMapsLargeForPaperBesideThePage) {
  const MadeRun run(0.1);
  RunReportOptions options;
  options.picture_width = 480;
  options.print_width = 1700;
  write_run_report(run.folder.path(), kTemplates, options);
  const pipeline::RunFolder files{run.folder.path()};
  const std::string png = files::read_text(files.images() / "map-height_print.png");
  // The width stands in bytes 16 to 19 of a PNG file, most significant first.
  EXPECT_EQ(256 * static_cast<unsigned char>(png.at(18)) + static_cast<unsigned char>(png.at(19)),
            1700);
  EXPECT_FALSE(std::filesystem::exists(files.images() / "error-over-time_print.png"))
      << "lines have SVG and PDF";
  EXPECT_THAT(files::read_text(files.report()), Not(HasSubstr("_print")));
}

TEST(RunReport, ShowsHowFramesOfTheWorstSegmentsWereRegistered) {
  const MadeRun run(0.1);
  const pipeline::RunFolder files{run.folder.path()};
  const RunData data = read_run(run.folder.path(), pipeline::RunPart::kAll);
  const auto worst = evaluation::worst_segments(data.evaluation, {}).segments.at(1);
  const auto frame = static_cast<std::uint32_t>(worst.first + 3);  // made frames count from 0
  dataset::PointCloud cloud;
  cloud.add("frame", std::vector<std::uint32_t>(4, frame));
  for (const char* axis : {"x", "y", "z"}) cloud.add(axis, std::vector<float>{1, 2, 3, 4});
  cloud.add("kind", std::vector<std::uint8_t>{0, 1, 2, 2});
  for (const char* axis : {"offset_x", "offset_y", "offset_z"}) {
    cloud.add(axis, std::vector<float>{0, 0.1F, 0.2F, 0.3F});
  }
  dataset::write_ply(files.worst_frames(), cloud);
  write_run_report(run.folder.path(), kTemplates);
  const std::string page = files::read_text(files.report());
  EXPECT_THAT(page, HasSubstr("Frame " + std::to_string(frame) +
                              ": its scan and its matches, 1 on lines and 2 on planes"));
  EXPECT_THAT(page, HasSubstr("Number 1 of the worst segments"));
  EXPECT_THAT(page, HasSubstr("the map around it")) << "of a segment without a kept frame";
  EXPECT_TRUE(std::filesystem::exists(files.images() / "worst-segment-2_dark.png"));
}

TEST(RunReport, NamesTheFileThatIsMissingOrDamaged) {
  const MadeRun run(0.1);
  const pipeline::RunFolder files{run.folder.path()};
  const auto error = [&] {
    try {
      write_run_report(run.folder.path(), kTemplates);
    } catch (const files::InputError& input_error) {
      return input_error.file().filename().string();
    }
    return std::string("no error");
  };
  files::write_text(files.factor_bench(), "{\"frame\": 3}");
  EXPECT_EQ(error(), "factor_bench.json");
  files::write_text(files.jacobians(), "{}");
  EXPECT_EQ(error(), "jacobians.json");
  files::write_text(files.evaluation(), "{\"ape\": 3}");
  EXPECT_EQ(error(), "evaluation.json");
  files::write_text(files.record(), "{");
  EXPECT_EQ(error(), "run.json");
  std::filesystem::remove(files.record());
  EXPECT_EQ(error(), "run.json");
}

}  // namespace
}  // namespace traverse::report
