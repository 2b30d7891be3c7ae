#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/dataset/trajectory_files.hpp"
#include "traverse/evaluation/json.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/text_file.hpp"

#include "end_to_end/program.hpp"
#include "evaluation/golden_trajectories.hpp"
#include "temporary_folder.hpp"

namespace traverse {
namespace {

using ::testing::HasSubstr;
using testing::ProgramResult;
using testing::run_program;
using testing::TemporaryFolder;
using Json = nlohmann::json;

/// The golden pair as files, named so that their folder is also a run folder.
class EvaluateCommand : public ::testing::Test {
 protected:
  EvaluateCommand() {
    dataset::write_tum(folder_ / "trajectory.tum", testing::golden_estimate());
    dataset::write_tum(folder_ / "reference.tum", testing::golden_reference());
  }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string both_files() const {
    return "evaluate " + file("trajectory.tum") + " --reference " + file("reference.tum");
  }
  Json json_of(const std::string& arguments) const {
    const ProgramResult outcome = run_program(arguments + " --json " + file("out.json"));
    EXPECT_EQ(outcome.status, 0) << outcome.everything();
    return Json::parse(files::read_text(folder_ / "out.json"));
  }

  TemporaryFolder folder_;
};

TEST_F(EvaluateCommand, GivesTheKnownFiguresAsTableAndJson) {
  const std::string arguments =
      both_files() + " --align se3 --rpe 10f --rpe 20m --all-pairs --relation translation";
  EXPECT_THAT(run_program(arguments).everything(), HasSubstr("APE, SE(3) alignment"));
  const Json json = json_of(arguments);
  EXPECT_EQ(json.at("association").at("pairs"), 514);
  EXPECT_NEAR(json.at("ape").at("translation").at("rmse"), 2.008707081862, 1e-9);
  EXPECT_NEAR(json.at("rpe").at(0).at("stats").at("rmse"), 0.435186732032, 1e-9);
  EXPECT_NEAR(json.at("rpe").at(1).at("stats").at("rmse"), 0.731867043314, 1e-9);
  EXPECT_NEAR(json.at("kitti").at("translation_percent"), 2.111629877802, 1e-9);
  EXPECT_EQ(json.at("estimate").at("name"), file("trajectory.tum"));
  EXPECT_EQ(json.at("ape").size(), 1U);
}

TEST_F(EvaluateCommand, WithoutRelationAndRpeShowsASummary) {
  const Json json = json_of(both_files());
  EXPECT_EQ(json.at("alignment").at("mode"), "none");
  EXPECT_EQ(json.at("ape").size(), 2U);
  ASSERT_EQ(json.at("rpe").size(), 2U);
  EXPECT_EQ(json.at("rpe").at(1).at("relation"), "angle-deg");
  EXPECT_EQ(json.at("rpe").at(1).at("delta"), 1);
}

TEST_F(EvaluateCommand, EveryOptionArrives) {
  const Json json = json_of(
      "evaluate --relation full --rpe 5deg " + file("trajectory.tum") + " --reference " +
      file("reference.tum") +
      " --format tum --align sim3 --align-first 50 --max-time-difference 0.002 --time-offset 0.001 "
      "--relation point-distance-ratio --relation full --pairs-from reference --kitti-step 1");
  EXPECT_EQ(json.at("alignment").at("mode"), "sim3");
  EXPECT_EQ(json.at("alignment").at("poses_used"), 50);
  EXPECT_EQ(json.at("association").at("max_time_difference"), 0.002);
  EXPECT_EQ(json.at("association").at("time_offset"), 0.001);
  EXPECT_LT(json.at("association").at("pairs"), 514);
  EXPECT_EQ(json.at("ape").size(), 1U);  // the ratio has no absolute form
  EXPECT_EQ(json.at("rpe").size(), 2U);
  EXPECT_EQ(json.at("rpe").at(0).at("unit"), "deg");
  EXPECT_EQ(json.at("rpe").at(0).at("pairs_from"), "reference");
  EXPECT_EQ(json.at("kitti").at("step"), 1);
}

TEST_F(EvaluateCommand, TakesARunFolderAndItsFrameOfTheDrift) {
  EXPECT_EQ(json_of("evaluate " + folder_.path().string()).at("kitti").at("frame"), "body");

  evaluation::EvaluationOptions options;
  options.kitti.T_body_camera = geometry::Pose3{Eigen::Matrix3d::Identity(), {0.27, 0, -0.08}};
  options.kitti.camera_frame = "camera 0";
  const evaluation::Evaluation of_run =
      evaluate(testing::golden_estimate(), testing::golden_reference(), options);
  files::write_text(folder_ / "evaluation.json", to_json(of_run));
  const Json json = json_of("evaluate " + folder_.path().string());
  EXPECT_EQ(json.at("kitti").at("frame"), "camera 0");
  EXPECT_NEAR(json.at("kitti").at("translation_percent"),
              of_run.comparison->kitti->translation_percent, 1e-9);
}

TEST_F(EvaluateCommand, WrongUsageIsStatusTwo) {
  for (const std::string& arguments :
       {std::string("evaluate"), "evaluate " + file("trajectory.tum"), both_files() + " --rpe 10",
        both_files() + " --align best", both_files() + " --align-first 50",
        both_files() + " --align se3 --align-first -1", both_files() + " --max-time-difference -1",
        both_files() + " --time-offset nan", both_files() + " --relation speed",
        both_files() + " --kitti-step 0", both_files() + " --unknown"}) {
    EXPECT_EQ(run_program(arguments).status, 2) << arguments;
  }
  EXPECT_EQ(run_program("evaluate --help").status, 0);
}

TEST_F(EvaluateCommand, WhatCannotBeEvaluatedIsStatusOneAndWritesNothing) {
  const auto expect_failure = [&](const std::string& arguments, const std::string& message) {
    const ProgramResult outcome = run_program(arguments + " --json " + file("out.json"));
    EXPECT_EQ(outcome.status, 1) << arguments;
    EXPECT_THAT(outcome.everything(), HasSubstr(message));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.json"));
  };
  expect_failure(both_files() + " --time-offset 1e6", "no pose of the estimate is within 0.01 s");
  expect_failure(both_files() + " --rpe 100000m", "no consecutive pair of poses is 100000 m apart");
  expect_failure(both_files() + " --format kitti", "line 1: expected the 12 numbers");
  expect_failure("evaluate " + file("none") + " --reference " + file("reference.tum"), "none");
  std::filesystem::remove(folder_ / "reference.tum");
  expect_failure("evaluate " + folder_.path().string(), "reference.tum: expected a readable file");
  EXPECT_THAT(run_program("evaluate " + file("trajectory.tum") + " --reference " +
                          file("trajectory.tum") + " --json " + file("no/such/folder"))
                  .everything(),
              HasSubstr("cannot be written"));
}

TEST_F(EvaluateCommand, TimesCutBothTrajectories) {
  const auto estimate = testing::golden_estimate();
  const double from = estimate.stamp(100).seconds();
  const double to = estimate.stamp(299).seconds();
  const Json json = json_of(both_files() + " --from " + std::to_string(from - 0.01) + " --to " +
                            std::to_string(to + 0.01));
  EXPECT_EQ(json.at("estimate").at("poses"), 200);
  const ProgramResult none = run_program(both_files() + " --from 1e6");
  EXPECT_EQ(none.status, 1);
  EXPECT_THAT(none.messages, HasSubstr("expected poses from --from until --to, found none"));
  EXPECT_EQ(run_program(both_files() + " --from 2 --to 1").status, 2);
}

TEST_F(EvaluateCommand, SurveyedPointsStandInForAReference) {
  const auto reference = testing::golden_reference();
  std::string points = "name,stamp_s,e_m,n_m,h_m,sigma_m,use\n";
  for (std::size_t k = 0; k < 12; ++k) {
    const std::size_t pose = 5 + k * (reference.size() - 10) / 12;
    const Eigen::Vector3d p = reference.pose(pose).translation;
    points += fmt::format("P{},{},{},{},{},0.02,{}\n", k, to_text(reference.stamp(pose)),
                          p.x() + 0.02, p.y(), p.z() - 0.01, k % 3 == 0 ? "control" : "check");
  }
  files::write_text(folder_ / "points.csv", points);
  const std::string arguments =
      "evaluate " + file("reference.tum") + " --checkpoints " + file("points.csv");
  const Json json = json_of(arguments + " --align none");
  EXPECT_EQ(json.at("control").at("count"), 4);
  EXPECT_NEAR(json.at("check").at("rmse_horizontal_m"), 0.02, 1e-6);
  EXPECT_NEAR(json.at("residuals").at(7).at("residual_m").at(2), 0.01, 1e-6);
  EXPECT_NEAR(json_of(arguments).at("check").at("rmse_3d_m"), 0, 1e-6)
      << "the offset is one for all";
  EXPECT_EQ(run_program(arguments + " --align origin").status, 2);
}

TEST_F(EvaluateCommand, PicturesAreDrawnOfStampedPosesAndOfNumberedOnes) {
  dataset::write_kitti(folder_ / "a.txt", testing::golden_reference());
  for (const std::string& arguments :
       {both_files(), "evaluate " + file("a.txt") + " --reference " + file("a.txt")}) {
    std::filesystem::remove_all(folder_ / "pictures");
    const ProgramResult drawn = run_program(arguments + " --align se3 --plot " + file("pictures"));
    ASSERT_EQ(drawn.status, 0) << drawn.everything();
    EXPECT_THAT(drawn.output, HasSubstr("pictures in " + file("pictures")));
    for (const char* name : {"trajectory-above.png", "trajectory-above.svg", "error-over-time.pdf",
                             "error-distribution_dark.png", "trajectory-error.png"}) {
      EXPECT_TRUE(std::filesystem::exists(folder_ / "pictures" / name)) << name;
    }
  }
}

}  // namespace
}  // namespace traverse
