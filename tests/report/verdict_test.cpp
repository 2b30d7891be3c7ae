#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "figures/run_figures.hpp"
#include "made_run.hpp"
#include "run/run_data.hpp"
#include "sections/sections.hpp"
#include "temporary_folder.hpp"

/// The words at the top of the page.
namespace traverse::report {
namespace {

using pipeline::Health;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// A made run, whose assessment a test may replace.
class Verdict : public ::testing::Test {
 protected:
  Verdict() { read({}); }

  void read(const MadeRunOptions& options) {
    std::filesystem::remove_all(folder_ / "run");
    std::filesystem::create_directory(folder_ / "run");
    make_run(folder_ / "run", options);
    run_ = read_run(folder_ / "run", pipeline::RunPart::kAll);
    run_.record["skipped_records"] = nlohmann::json::object();
    run_.record["frames"]["skipped"] = nlohmann::json::object();
    run_.health.skipped_records = 0;
  }
  /// Poses by fixes and wheels, with two outages.
  void make_navigation() {
    pipeline::FrameTable frames(
        {"frame", "stamp_s", "inertial_chi2", "outage_error_m", "total_ms"});
    for (std::size_t i = 0; i < 60; ++i) {
      const auto k = static_cast<double>(i);
      frames.add_row({k, 0.1 * k, 9, i == 20 ? 3.0 : i == 40 ? 4.0 : 0, 10});
    }
    run_.frames = std::move(frames);
    run_.health = {};
    run_.health.is_navigation = true;
  }
  void judge(Health severity, const std::string& code, const std::string& text) {
    run_.health.verdict = severity;
    run_.health.reasons = {{severity, code, text}};
  }

  Model model() const {
    Model model;
    const auto figures = run_figures(run_);
    add_verdict(run_, figures, model);
    add_headlines(run_, figures, nullptr, model);
    return model;
  }
  std::string sentence() const { return model().json["verdict"]; }
  /// "fail Lost: ..." for each notice.
  std::vector<std::string> notices() const {
    std::vector<std::string> list;
    const Json told = model().json["notices"];
    for (const Json& notice : told) {
      list.push_back(notice["kind"].get<std::string>() + " " + notice["word"].get<std::string>() +
                     ": " + notice["text"].get<std::string>());
    }
    return list;
  }

  std::string first_notice() const { return notices().front(); }

  testing::TemporaryFolder folder_;
  RunData run_;
};

TEST_F(Verdict, LeadsWithTheDriftOfKittiItsSegmentsAndInterval) {
  EXPECT_THAT(sentence(), StartsWith("Drift "));
  EXPECT_THAT(sentence(), HasSubstr(" segments"));
  EXPECT_THAT(sentence(), HasSubstr("APE "));
  EXPECT_THAT(sentence(), HasSubstr("nothing skipped"));
  EXPECT_THAT(sentence(), Not(HasSubstr("losing error")));
}

TEST_F(Verdict, OfAShortRunLeadsWithTheAbsoluteErrorAndTellsTheClosingErrorInMetres) {
  MadeRunOptions options;
  options.frames = 30;
  read(options);
  EXPECT_THAT(sentence(), StartsWith("APE "));
  EXPECT_THAT(sentence(), HasSubstr("closing error"));
  EXPECT_THAT(sentence(), Not(HasSubstr("rift")));
  EXPECT_THAT(sentence(), Not(HasSubstr("%")));
}

TEST_F(Verdict, WithoutAReferenceTellsTheWay) {
  MadeRunOptions options;
  options.with_reference = false;
  read(options);
  EXPECT_THAT(sentence(), StartsWith("Drove "));
}

TEST_F(Verdict, OfALostRunTellsNothingElse) {
  judge(Health::kLost, "not_registered", "0 of 59 frames were registered (0 %).");
  EXPECT_EQ(sentence(), "Lost: 0 of 59 frames were registered (0 %).");
  EXPECT_THAT(first_notice(), StartsWith("fail Lost: 0 of 59"));
  EXPECT_THAT(notices(), ::testing::Contains(HasSubstr("No score")));
  EXPECT_THAT(notices(), Not(::testing::Contains(HasSubstr("Healthy"))));
}

TEST_F(Verdict, OfADegradedRunBeginsWithWhy) {
  judge(Health::kDegraded, "gap", "There is no frame for 3.1 s after frame 19.");
  EXPECT_THAT(sentence(),
              StartsWith("Degraded: There is no frame for 3.1 s after frame 19. Drift"));
  EXPECT_THAT(sentence(), Not(HasSubstr("nothing skipped")));
  EXPECT_THAT(first_notice(), StartsWith("warn Degraded: There is no frame"));
}

TEST_F(Verdict, OfARunThatFixesHoldLeadsWithItsErrorAndThatAfterOutages) {
  make_navigation();
  EXPECT_THAT(sentence(), StartsWith("APE "));
  EXPECT_THAT(sentence(), HasSubstr("3.54 m after GNSS outages"));  // rms of 3 and 4
  EXPECT_THAT(sentence(), Not(HasSubstr("rift")));
}

TEST_F(Verdict, HealthyIsARunOfWhichNoSensorWasRejected) {
  make_navigation();
  EXPECT_THAT(notices(), ::testing::ElementsAre(StartsWith("good Healthy")));
  pipeline::SensorUse gnss{.label = "GNSS", .kind = sensors::SensorKind::kGnss};
  gnss.used = 80;
  gnss.rejected = 2;
  run_.health.sensors = {gnss};
  EXPECT_THAT(notices(),
              ::testing::ElementsAre(HasSubstr("2 of 82 readings of GNSS, no two in a row")));
  run_.health.sensors.front().longest_rejected_s = 3.44;
  EXPECT_THAT(notices(), ::testing::ElementsAre(HasSubstr("GNSS, in stretches of up to 3.4 s:")));
  judge(Health::kDegraded, "restarted", "The estimator gave up what it knew and began again once.");
  EXPECT_THAT(first_notice(), StartsWith("warn Degraded"));
  EXPECT_THAT(sentence(), Not(HasSubstr("nothing skipped")));
}

TEST_F(Verdict, WarningsOfTheComparisonAndStepsOfTheClockAreTold) {
  run_.evaluation.comparison->warnings = {"only 1 of 120 poses has a pair"};
  run_.record["recording"]["facts"] = nlohmann::json::array(
      {{{"name", "clock set back"}, {"value", "lidar: by 100.000 s"}, {"reason", "moved"}},
       {{"name", "sensor"}, {"value", "HDL-64E"}, {"reason", "stated"}}});
  EXPECT_THAT(notices(), ::testing::IsSupersetOf(
                             {std::string("warn Comparison: only 1 of 120 poses has a pair"),
                              std::string("warn Clock set: lidar: by 100.000 s; moved.")}));
  EXPECT_THAT(notices(), Not(::testing::Contains(HasSubstr("HDL-64E"))));
}

TEST_F(Verdict, AReferenceThatIsNotUsedIsTold) {
  run_.record["recording"]["reference_refused"] = "poses.txt: expected calib.txt with Tr";
  EXPECT_THAT(notices(), ::testing::Contains(HasSubstr("Reference not used: poses.txt")));
}

TEST_F(Verdict, EveryHeadlineSaysByWhichRule) {
  const Json figures = model().json["figures"];
  EXPECT_THAT(figures["kitti_translation_percent"]["how"].get<std::string>(), HasSubstr("KITTI"));
  EXPECT_THAT(figures["ape_rmse_m"]["how"].get<std::string>(), HasSubstr("rmse"));
  EXPECT_THAT(figures["closing_error_m"]["how"].get<std::string>(), HasSubstr("end points"));
  EXPECT_THAT(figures["frame_median_ms"]["how"].get<std::string>(), HasSubstr("median"));
  EXPECT_THAT(figures["frame_p95_ms"]["how"].get<std::string>(), HasSubstr("linear between ranks"));
}

}  // namespace
}  // namespace traverse::report
