#include "traverse/evaluation/checkpoints.hpp"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/evaluation/evaluation_error.hpp"
#include "traverse/files/atomic_file.hpp"
#include "traverse/files/input_error.hpp"
#include "traverse/geometry/so3.hpp"

#include "geometry/random_motion.hpp"
#include "temporary_folder.hpp"

namespace traverse::evaluation {
namespace {

using geometry::Pose3;
using geometry::Stamp;
using geometry::Trajectory;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::RandomMotion;
using testing::TemporaryFolder;

constexpr std::size_t kPoints = 12;

/// A drive over hills and round a bend, ten poses a second, and points that it was at, on a grid
/// like UTM's, each off by its part of 2 cm.
struct SurveyedDrive {
  Trajectory path;  ///< in a map of its own
  Pose3 T_enh_map;
  Eigen::Vector3d p_body{0.4, -0.2, 1.5};  ///< the antenna
  std::vector<Checkpoint> points;
  std::array<Eigen::Vector3d, kPoints> survey_error_m;

  SurveyedDrive() {
    for (int i = 0; i <= 1200; ++i) {
      const double t = 0.1 * i;
      Pose3 pose;
      pose.rotation = geometry::exp_so3(Eigen::Vector3d(0.02 * std::sin(t), 0.03, 0.02 * t));
      pose.translation = {200 * std::sin(0.02 * t), 200 * (1 - std::cos(0.02 * t)),
                          3 * std::sin(0.1 * t)};
      path.push_back(Stamp::from_seconds(1'700'000'000 + t), pose);
    }
    T_enh_map.rotation = geometry::exp_so3(Eigen::Vector3d(0.01, -0.02, 1.2));
    T_enh_map.translation = {455'812.25, 5'427'903.5, 112.75};
    RandomMotion random(7);
    for (std::size_t k = 0; k < kPoints; ++k) {
      const std::size_t pose = 100 * k + 3;
      survey_error_m[k] = 0.02 * random.vector(1);
      Checkpoint point;
      point.name = "P" + std::to_string(k);
      point.stamp = path.stamp(pose);
      point.p_enh = T_enh_map * (path.pose(pose) * p_body) + survey_error_m[k];
      point.sigma_m = Eigen::Vector3d::Constant(0.02);
      points.push_back(point);
    }
  }

  CheckpointEvaluation evaluate(AlignmentMode mode) const {
    CheckpointOptions options;
    options.alignment = mode;
    options.p_body = p_body;
    return evaluate_checkpoints(path, points, options);
  }
};

TEST(Checkpoints, ResidualsAreTheSurveysErrorsWhereTheEstimateIsRight) {
  SurveyedDrive drive;
  drive.path = drive.path.transformed_left(drive.T_enh_map);  // on the grid already
  const CheckpointEvaluation found = drive.evaluate(AlignmentMode::kNone);
  ASSERT_EQ(found.residuals.size(), kPoints);
  double horizontal = 0;
  double vertical = 0;
  for (std::size_t k = 0; k < kPoints; ++k) {
    const Eigen::Vector3d by_hand = -drive.survey_error_m[k];
    EXPECT_LT((found.residuals[k].residual_m - by_hand).norm(), 1e-6) << k;
    horizontal += by_hand.x() * by_hand.x() + by_hand.y() * by_hand.y();
    vertical += by_hand.z() * by_hand.z();
  }
  EXPECT_FALSE(found.control);
  EXPECT_NEAR(found.check->rmse_horizontal_m, std::sqrt(horizontal / kPoints), 1e-6);
  EXPECT_NEAR(found.check->rmse_vertical_m, std::sqrt(vertical / kPoints), 1e-6);
  EXPECT_NEAR(found.check->rmse_3d_m, std::sqrt((horizontal + vertical) / kPoints), 1e-6);
  EXPECT_NEAR(found.check->survey_vertical_m, 0.02, 1e-12);
}

TEST(Checkpoints, ControlPointsAlignAndTheOthersCheck) {
  SurveyedDrive drive;
  std::vector<Eigen::Vector3d> x;
  std::vector<Eigen::Vector3d> y;
  for (std::size_t k = 0; k < kPoints; k += 3) {
    drive.points[k].is_control = true;
    x.push_back(drive.path.pose(100 * k + 3) * drive.p_body);
    y.push_back(drive.points[k].p_enh);
  }
  const CheckpointEvaluation found = drive.evaluate(AlignmentMode::kSe3);
  EXPECT_EQ(found.aligned_by, 4U);
  EXPECT_EQ(found.control->count, 4U);
  EXPECT_EQ(found.check->count, 8U);
  // The same by the alignment that errors of trajectories are told by.
  const Pose3 T = geometry::umeyama(x, y, false).T_y_x;
  for (std::size_t k = 0; k < kPoints; ++k) {
    const Eigen::Vector3d by_hand =
        T * (drive.path.pose(100 * k + 3) * drive.p_body) - drive.points[k].p_enh;
    EXPECT_LT((found.residuals[k].residual_m - by_hand).norm(), 1e-6) << k;
  }
}

TEST(Checkpoints, APrismIsFollowedByAClockOfItsOwn) {
  // Every tenth of a second, without names, 37.02 s early; the lever arm is needed, and the offset.
  SurveyedDrive drive;
  const TemporaryFolder folder;
  std::string table = "stamp_s,e_m,n_m,h_m,sigma_e_m,sigma_n_m,sigma_h_m\n";
  for (std::size_t i = 20; i < 220; i += 2) {
    const Eigen::Vector3d p = drive.T_enh_map * (drive.path.pose(i) * drive.p_body);
    const double stamp = geometry::seconds_between(Stamp{0}, drive.path.stamp(i)) - 37.02;
    table += fmt::format("{:.9f},{:.6f},{:.6f},{:.6f},0.002,0.002,0.004\n", stamp, p.x(), p.y(),
                         p.z() + (i % 4 == 0 ? 0.004 : -0.004));
  }
  files::write_text(folder / "prism.csv", table);
  CheckpointOptions options;
  options.p_body = drive.p_body;
  options.time_offset_s = 37.02;
  const auto points = read_checkpoints(folder / "prism.csv");
  const CheckpointEvaluation found = evaluate_checkpoints(drive.path, points, options);
  ASSERT_EQ(found.check->count, 100U);
  EXPECT_LT(found.check->rmse_horizontal_m, 1e-4);
  EXPECT_NEAR(found.check->rmse_vertical_m, 0.004, 1e-5);
  EXPECT_NEAR(found.check->survey_vertical_m, 0.004, 1e-12);
  EXPECT_NEAR(*found.check->normalised_vertical, 1, 0.01);
  EXPECT_THAT(to_table(found), HasSubstr("the 40 largest of 100"));
  EXPECT_THAT(to_table(found), HasSubstr("weighted by the reference's own variances"));
  files::write_text(folder / "residuals.json", to_json(found));
  EXPECT_EQ(to_json(read_checkpoint_evaluation(folder / "residuals.json")), to_json(found));
  options.time_offset_s = 36.02;
  EXPECT_GT(evaluate_checkpoints(drive.path, points, options).check->rmse_horizontal_m, 0.01);
}

TEST(Checkpoints, FixesOfAReceiverCountByTheirVariances) {
  const TemporaryFolder folder;
  files::write_text(
      folder / "gnss.csv",
      "stamp_s,latitude_deg,longitude_deg,altitude_m,heading_deg,east_m,north_m,up_m\n"
      "1,48,11,500,,0.01,0.01,0.02\n2,48.0001,11,500,,0.01,0.01,0.02\n"
      "3,48.0001,11.0001,500,90,1,1,2\n");
  const auto fixes = read_checkpoints(folder / "gnss.csv");
  ASSERT_EQ(fixes.size(), 3U);
  EXPECT_EQ(fixes[0].p_enh.norm(), 0);
  EXPECT_NEAR(fixes[1].p_enh.y(), 11.12, 0.01);  // a ten-thousandth of a degree of the meridian
  EXPECT_NEAR(fixes[2].p_enh.x(), 7.46, 0.01);
  EXPECT_EQ(fixes[2].sigma_m.z(), 2);
  Trajectory path;
  for (const Checkpoint& fix : fixes) {
    Pose3 pose;
    pose.translation = fix.p_enh;
    if (fix.name == "3") pose.translation.x() += 1;
    path.push_back(*fix.stamp, pose);
  }
  CheckpointOptions options;
  options.alignment = AlignmentMode::kNone;
  const auto figures = *evaluate_checkpoints(path, fixes, options).check;
  EXPECT_NEAR(figures.rmse_horizontal_m, std::sqrt(1.0 / 3), 1e-9);
  // By hand: weights 5000, 5000 and 0.5, of which the last has 1 m^2.
  EXPECT_NEAR(*figures.weighted_horizontal_m, std::sqrt(0.5 / 10000.5), 1e-9);
  EXPECT_NEAR(*figures.normalised_horizontal, std::sqrt(0.5 / 3), 1e-9);
}

TEST(Checkpoints, APointThatIsKnownBetterCountsMore) {
  SurveyedDrive drive;
  for (Checkpoint& point : drive.points) point.is_control = true;
  drive.points[5].p_enh.x() += 3;
  const double as_others = drive.evaluate(AlignmentMode::kSe3).residuals[5].residual_m.x();
  drive.points[5].sigma_m.setConstant(2);
  const double as_itself = drive.evaluate(AlignmentMode::kSe3).residuals[5].residual_m.x();
  EXPECT_GT(as_others, -2.9);
  EXPECT_NEAR(as_itself, -3, 0.05);
}

TEST(Checkpoints, StopsAreFoundAndTheirPosesAveraged) {
  Trajectory path;
  for (int i = 0; i < 200; ++i) {
    Pose3 pose;  // 5 m/s, standing from the 5th to the 9th second
    const double t = 0.1 * i;
    pose.translation.x() = 5 * (t < 5 ? t : t < 9 ? 5 : t - 4);
    if (t >= 5 && t < 9) pose.translation.y() = i % 2 == 0 ? 0.01 : -0.01;
    path.push_back(Stamp::from_seconds(t), pose);
  }
  ASSERT_EQ(find_stops(path).size(), 1U);
  Checkpoint point;
  point.name = "stop";
  point.stop = 1;
  point.p_enh = {25, 0, 0};
  CheckpointOptions options;
  options.alignment = AlignmentMode::kNone;
  EXPECT_LT(evaluate_checkpoints(path, {point}, options).residuals[0].residual_m.norm(), 0.03);
  point.stop = 2;
  EXPECT_THROW(evaluate_checkpoints(path, {point}, options), EvaluationError);
}

TEST(Checkpoints, WhatCannotBeUsedIsTold) {
  SurveyedDrive drive;
  drive.points[2].stamp = Stamp::from_seconds(5);
  const CheckpointEvaluation found = drive.evaluate(AlignmentMode::kSe3);
  EXPECT_EQ(found.residuals.size(), kPoints - 1);
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_THAT(found.notes[0], HasSubstr("P2 is not used: no poses around 5.000000000 s"));
  EXPECT_TRUE(found.is_by_all);
  EXPECT_THAT(to_table(found), HasSubstr("so that nothing checks them"));
  const auto json = nlohmann::json::parse(to_json(found));
  EXPECT_EQ(json["residuals"].size(), kPoints - 1);
  drive.points.resize(2);
  try {
    drive.evaluate(AlignmentMode::kSe3);
    ADD_FAILURE();
  } catch (const EvaluationError& error) {
    EXPECT_THAT(error.what(), HasSubstr("at least three points that are not on one line"));
    EXPECT_THAT(error.what(), HasSubstr("--align none"));
  }
}

std::string refusal_of_points(const std::string& text) {
  const TemporaryFolder folder;
  files::write_text(folder / "points.csv", text);
  try {
    read_checkpoints(folder / "points.csv");
  } catch (const files::InputError& error) {
    return error.place().text + ": " + error.expected() + " | " + error.found();
  }
  return "read";
}

TEST(Checkpoints, AFileTellsPointsByMomentIntervalOrStop) {
  const TemporaryFolder folder;
  files::write_text(folder / "points.csv",
                    "name,stamp_s,from_s,to_s,stop,e_m,n_m,h_m,sigma_m,use\n"
                    "A,12.5,,,,455812.25,5427903.5,112.75,0.02,control\n"
                    "B,,20,25,,1,2,3,0.03,check\nC,,,,2,4,5,6,0.02,\n");
  const auto points = read_checkpoints(folder / "points.csv");
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[0].stamp, Stamp::from_seconds(12.5));
  EXPECT_EQ(points[0].p_enh, Eigen::Vector3d(455812.25, 5427903.5, 112.75));
  EXPECT_TRUE(points[0].is_control);
  EXPECT_EQ(points[1].until, Stamp::from_seconds(25));
  EXPECT_EQ(points[2].stop, 2U);
  EXPECT_EQ(points[2].sigma_m, Eigen::Vector3d::Constant(0.02));
}

TEST(Checkpoints, AFileThatIsWrongIsToldWithItsLine) {
  EXPECT_THAT(refusal_of_points("name,x\n"), HasSubstr("line 1: a header with the columns name; "));
  EXPECT_THAT(refusal_of_points("name,e_m,n_m\n"), HasSubstr("| no h_m"));
  const std::string head = "name,stamp_s,e_m,n_m,h_m,sigma_m,use\n";
  EXPECT_EQ(refusal_of_points(head + "A,1,x,2,3,0.02,\n"), "line 2: a number under e_m | 'x'");
  EXPECT_EQ(refusal_of_points(head + "A,1,1,2,3,0,\n"),
            "line 2: a standard deviation above 0 under sigma_m | '0'");
  EXPECT_EQ(refusal_of_points(head + "A,1,1,2,3,0.02,both\n"),
            "line 2: control or check under use | 'both'");
  EXPECT_EQ(refusal_of_points(head + "A,1,1,2,3,0.02,\nA,1,1,2,3,0.02,\n"),
            "line 3: a name that no other point has | 'A'");
  EXPECT_EQ(refusal_of_points(head), ": at least one point | none");
}

}  // namespace
}  // namespace traverse::evaluation
