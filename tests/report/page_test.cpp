#include "page.hpp"

#include <cmath>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/evaluation/evaluate.hpp"
#include "traverse/evaluation/json.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/files/text_file.hpp"
#include "traverse/optimization/jacobian_audit.hpp"
#include "traverse/pipeline/frame_table.hpp"
#include "traverse/pipeline/run_folder.hpp"
#include "traverse/pipeline/run_record.hpp"
#include "traverse/report/run_report.hpp"

#include "run_data.hpp"
#include "temporary_folder.hpp"

namespace traverse::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::TemporaryFolder;

constexpr const char* kEvil = "<script>alert('x')</script> & \"quoted\"";

/// A run folder of a drive along a curve, made by hand; the estimate is `error_m` off sideways.
class MadeRun {
 public:
  explicit MadeRun(double error_m, bool with_reference = true) {
    const pipeline::RunFolder files{folder.path()};
    geometry::Trajectory estimate;
    geometry::Trajectory reference;
    pipeline::FrameTable frames({"frame", "stamp_s", "registered", "degenerate_directions",
                                 "residual_rms_m", "inlier_share", "line_matches", "plane_matches",
                                 "eigenvalue_1", "solve_ms", "total_ms"});
    for (int i = 0; i < 60; ++i) {
      geometry::Pose3 pose;
      pose.translation = {2.0 * i, 0.01 * i * i, 0};
      const auto stamp = geometry::Stamp::from_seconds(0.1 * i);
      reference.push_back(stamp, pose);
      pose.translation.y() += error_m * std::sin(0.5 * i);
      estimate.push_back(stamp, pose);
      frames.add_row(
          {1.0 * i, 0.1 * i, i == 0 ? 0.0 : 1.0, degenerate(i), 0.05, 0.9, 100, 500, 0.2, 4, 9});
    }
    dataset::write_tum(files.trajectory(), estimate);
    frames.write_csv(files.frames());
    evaluation::Evaluation evaluation = evaluation::evaluate(estimate);
    if (with_reference) {
      dataset::write_tum(files.reference(), reference);
      evaluation = evaluation::evaluate(estimate, reference, evaluation::run_evaluation_options());
    }
    files::write_text(files.evaluation(), evaluation::to_json(evaluation));
    dataset::PointCloud map;
    map.add("x", std::vector<float>{0, 10, 20});
    map.add("y", std::vector<float>{0, 5, -5});
    map.add("z", std::vector<float>{0, 1, 2});
    dataset::write_ply(files.map_points(), map);

    pipeline::RunRecord record;
    record.status = pipeline::RunStatus::kOk;
    record.pipeline = "floam";
    record.pipeline_description = kEvil;
    record.recording.name = kEvil;
    record.recording.path = kEvil;
    record.recording.facts.push_back({kEvil, kEvil, kEvil});
    record.settings.push_back({{"solver.huber_m", 0.2, kEvil, ""}, 0.1});
    record.skipped.add(kEvil, kEvil);
    record.command = {"traverse", kEvil};
    record.frames_used = 60;
    record.started_utc = "2026-01-02T03:04:05Z";
    pipeline::summarise_timing(frames, record);
    files::write_text(files.record(),
                      to_json(record, pipeline::build_info(), pipeline::host_info()));
  }

  std::string page() const { return make_page(read_run(folder.path()), {}, kTemplates); }

  static constexpr const char* kTemplates = TRAVERSE_SOURCE_DIR "/reports/templates";
  TemporaryFolder folder;

 private:
  static double degenerate(int i) { return i >= 20 && i < 25 ? 1 : 0; }
};

TEST(Page, ShowsUntrustedTextAndNeverRunsIt) {
  const std::string page = MadeRun(0.1).page();
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page,
              HasSubstr("&lt;script&gt;alert(&apos;x&apos;)&lt;/script&gt; &amp; &quot;quoted"));
}

TEST(Page, AsksTheNetworkForNothing) {
  const std::string page = MadeRun(0.1).page();
  const std::regex reference(R"((?:src|href|srcset|url)\s*[=(]\s*["']?([^"'\s)>]*))");
  for (std::sregex_iterator match(page.begin(), page.end(), reference), end; match != end;
       ++match) {
    const std::string target = (*match)[1];
    EXPECT_TRUE(target.starts_with("#") || target.starts_with("data:")) << target.substr(0, 80);
  }
}

TEST(Page, NumbersAreThoseOfTheEvaluation) {
  const MadeRun run(0.1);
  const RunData data = read_run(run.folder.path());
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
  write_run_report(run.folder.path(), MadeRun::kTemplates);
  const pipeline::RunFolder files{run.folder.path()};
  EXPECT_TRUE(std::filesystem::exists(files.images() / "trajectory-above.png"));
  EXPECT_TRUE(std::filesystem::exists(files.images() / "error-over-time_dark.png"));
  EXPECT_THAT(files::read_text(files.report()), HasSubstr("data:image/png;base64,iVBOR"));
}

TEST(RunReport, NamesTheFileThatIsMissingOrDamaged) {
  const MadeRun run(0.1);
  const pipeline::RunFolder files{run.folder.path()};
  const auto error = [&] {
    try {
      write_run_report(run.folder.path(), MadeRun::kTemplates);
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
