// References that are straight or stand still, and what of an alignment they determine.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "traverse/evaluation/evaluate.hpp"
#include "traverse/evaluation/json.hpp"
#include "traverse/evaluation/table.hpp"
#include "traverse/geometry/so3.hpp"

#include "evaluation/golden_trajectories.hpp"
#include "geometry/random_motion.hpp"

namespace traverse::evaluation {
namespace {

using geometry::Pose3;
using geometry::Stamp;
using geometry::Trajectory;
using ::testing::HasSubstr;
using testing::RandomMotion;

/// A body that drives straight on (or stands still) and looks ahead all the time.
std::vector<Pose3> line(std::size_t poses, double step_m, double noise_m, unsigned seed) {
  RandomMotion random(seed);
  const Pose3 T_map_line = random.pose(3, 100);
  std::vector<Pose3> list;
  for (std::size_t i = 0; i < poses; ++i) {
    Pose3 pose = T_map_line;
    pose.translation +=
        T_map_line.rotation * Eigen::Vector3d(step_m * static_cast<double>(i), 0, 0);
    for (int axis = 0; axis < 3; ++axis) pose.translation[axis] += random.uniform(-1, 1) * noise_m;
    list.push_back(pose);
  }
  return list;
}

/// The estimate of such a drive, in another map and with noise of its own.
std::vector<Pose3> estimate_of(const std::vector<Pose3>& reference, double noise_m, double scale) {
  RandomMotion random(99);
  const Pose3 T_other_map = random.pose(3, 50);
  std::vector<Pose3> list;
  for (const Pose3& pose : reference) {
    Pose3 estimate = T_other_map * pose;
    estimate.translation /= scale;
    for (int axis = 0; axis < 3; ++axis) {
      estimate.translation[axis] += random.uniform(-1, 1) * noise_m;
    }
    estimate.rotation *= geometry::exp_so3({random.uniform(-1e-3, 1e-3), 0, 0});
    list.push_back(estimate);
  }
  return list;
}

double largest_distance(const Poses& a, const Poses& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, (a[i].translation - b[i].translation).norm());
  }
  return largest;
}

Trajectory stamped(const std::vector<Pose3>& poses) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    trajectory.push_back(Stamp::from_seconds(0.1 * static_cast<double>(i)), poses[i]);
  }
  return trajectory;
}

// The reference exact or of GNSS noise, the estimate better or worse than it.
TEST(AlignmentExtent, ALineLeavesTheRotationAboutItOpen) {
  for (const double reference_noise_m : {0.0, 1e-4, 0.02}) {
    for (const double noise_m : {0.0, 1e-3, 0.05}) {
      for (unsigned seed = 0; seed < 10; ++seed) {
        const auto reference = line(120, 0.5, reference_noise_m, seed);
        const auto estimate = estimate_of(reference, noise_m, 1);
        if (reference_noise_m > noise_m) continue;  // the noise of the reference is in the estimate
        const Alignment found = align(estimate, reference, {AlignmentMode::kSe3, {}});
        const std::string where = std::to_string(reference_noise_m) + " " + std::to_string(noise_m);
        ASSERT_EQ(found.undetermined, Undetermined::kRotationAboutLine) << where;
        EXPECT_FALSE(found.determines_rotation());
        EXPECT_THAT(found.reason, HasSubstr("120 positions of the")) << where;
        // The positions fit all the same.
        const Poses fitted = aligned(estimate, found);
        EXPECT_LT(largest_distance(fitted, reference), 3 * (noise_m + reference_noise_m) + 1e-9);
      }
    }
  }
}

// Where least squares give no rotation about the line at all, the orientations do.
TEST(AlignmentExtent, WhatIsOpenIsAsTheOrientationsHaveIt) {
  std::vector<Pose3> reference;
  for (int i = 0; i < 20; ++i) {
    reference.push_back({geometry::exp_so3({0.1, -0.2, 0.3}), {static_cast<double>(i), 0, 0}});
  }
  std::vector<Pose3> estimate = reference;
  const Pose3 turned{geometry::exp_so3({2.5, 0, 0}), {0, 1, 0}};
  for (Pose3& pose : estimate) pose = turned * pose;
  const Alignment found = align(estimate, reference, {AlignmentMode::kSe3, {}});
  EXPECT_EQ(found.undetermined, Undetermined::kRotationAboutLine);
  EXPECT_LT((found.T_reference_estimate.matrix() - turned.inverse().matrix()).norm(), 1e-9);
}

TEST(AlignmentExtent, ALineDeterminesTheScale) {
  for (const double scale : {1.0, 1.25, 0.03}) {
    const auto reference = line(30, 0.5, 0, 3);
    const auto estimate = estimate_of(reference, 0, scale);
    const Alignment only = align(estimate, reference, {AlignmentMode::kScale, {}});
    EXPECT_NEAR(only.scale, scale, 1e-9 * scale);
    EXPECT_EQ(only.undetermined, Undetermined::kNothing);
    const Alignment both = align(estimate, reference, {AlignmentMode::kSim3, {}});
    EXPECT_NEAR(both.scale, scale, 1e-9 * scale);
    EXPECT_EQ(both.undetermined, Undetermined::kRotationAboutLine);
    EXPECT_LT(largest_distance(aligned(estimate, both), reference), 1e-9);
  }
}

TEST(AlignmentExtent, StandingStillLeavesAllOfTheRotationOpen) {
  for (const double reference_noise_m : {0.0, 1e-3, 0.02}) {
    for (const double noise_m : {0.0, 1e-3, 0.02}) {
      const auto reference = line(120, 0, reference_noise_m, 5);
      auto estimate = estimate_of(line(120, 0, 0, 5), noise_m, 1);
      const Alignment se3 = align(estimate, reference, {AlignmentMode::kSe3, {}});
      EXPECT_EQ(se3.undetermined, Undetermined::kRotation);
      EXPECT_LT(largest_distance(aligned(estimate, se3), reference),
                3 * (noise_m + reference_noise_m) + 1e-9);
      EXPECT_LT(absolute_error(se3(estimate[7]), reference[7], Relation::kAngleDeg), 1);
      const Alignment sim3 = align(estimate, reference, {AlignmentMode::kSim3, {}});
      EXPECT_EQ(sim3.undetermined, Undetermined::kRotationAndScale);
      EXPECT_EQ(sim3.scale, 1);
      const Alignment scale = align(estimate, reference, {AlignmentMode::kScale, {}});
      EXPECT_EQ(scale.undetermined, Undetermined::kScale);
      EXPECT_EQ(scale.scale, 1);
      EXPECT_TRUE(scale.determines_rotation());
    }
  }
}

TEST(AlignmentExtent, AnEstimateThatDoesNotMoveIsSaidToBeOnePoint) {
  const auto reference = line(20, 1, 0.1, 7);
  const std::vector<Pose3> estimate(20, Pose3::identity());
  const Alignment found = align(estimate, reference, {AlignmentMode::kSe3, {}});
  EXPECT_EQ(found.undetermined, Undetermined::kRotation);
  EXPECT_EQ(found.reason, "the 20 positions of the estimate are one point");
  EXPECT_EQ(align(Poses(estimate), Poses(estimate), {AlignmentMode::kSe3, 1}).reason,
            "there is one position");
}

TEST(AlignmentExtent, WhatTurnsIsDeterminedHoweverBadItIs) {
  const Trajectory reference = testing::golden_reference();
  RandomMotion random(3);
  for (const double noise_m : {0.0, 1.0, 10.0}) {
    for (const double scale : {1.0, 0.05, 30.0}) {
      const auto estimate = estimate_of(reference.poses(), noise_m / scale, scale);
      const Alignment found = align(estimate, reference.poses(), {AlignmentMode::kSe3, {}});
      EXPECT_EQ(found.undetermined, Undetermined::kNothing) << noise_m << " " << scale;
    }
  }
  // A road that sways by a metre in a hundred, known to 0.2 m.
  std::vector<Pose3> road;
  for (int i = 0; i < 300; ++i) {
    Pose3 pose;
    pose.translation = {0.5 * i, std::sin(0.05 * i), 0.3 * std::cos(0.03 * i)};
    road.push_back(pose);
  }
  EXPECT_EQ(align(estimate_of(road, 0.2, 1), road, {AlignmentMode::kSe3, {}}).undetermined,
            Undetermined::kNothing);
}

TEST(AlignmentExtent, AnEvaluationTellsWhatIsDetermined) {
  const auto reference = line(120, 0.5, 0, 2);
  const Trajectory truth = stamped(reference);
  const Trajectory estimate = stamped(estimate_of(reference, 0.01, 1));
  const Evaluation evaluation = evaluate(estimate, truth, run_evaluation_options());
  const Comparison& c = *evaluation.comparison;
  ASSERT_NE(find_ape(c, Relation::kTranslation), nullptr);
  EXPECT_LT(find_ape(c, Relation::kTranslation)->statistics.rmse, 0.02);
  EXPECT_NE(find_ape(c, Relation::kPointDistance), nullptr);
  for (const Relation relation :
       {Relation::kRotation, Relation::kFull, Relation::kAngleRad, Relation::kAngleDeg}) {
    EXPECT_EQ(find_ape(c, relation), nullptr) << name_of(relation);
  }
  EXPECT_EQ(c.ape_at_origin.size(), 6U);
  for (const Ape& ape : c.ape_at_origin) {
    if (ape.relation != Relation::kAngleDeg) continue;
    EXPECT_LT(ape.statistics.max, 1);
  }
  EXPECT_NEAR(c.path.reference_m, 0.5 * 119, 1e-9);
  EXPECT_LT(c.path.end_error_m, 0.2);
  EXPECT_FALSE(c.rpe.empty());

  const std::string table = to_table(evaluation);
  EXPECT_THAT(table, HasSubstr("SE(3) alignment, rotation about the line not determined"));
  EXPECT_THAT(table, HasSubstr("APE, aligned at the first pose"));
  EXPECT_THAT(table, HasSubstr("APE of rotations: rotation about the line of the se3 alignment is "
                               "not determined: the 120 positions of the reference lie on a line"));
  const std::string text = to_json(evaluation);
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json.at("alignment").at("undetermined"), "rotation about the line");
  EXPECT_FALSE(json.at("ape").contains("angle-deg"));
  EXPECT_TRUE(json.at("ape_at_origin").at("angle-deg").at("rmse").is_number());
  EXPECT_EQ(to_json(from_json(text)), text);
}

TEST(AlignmentExtent, AFewMatchesOfManyPosesAreAWarning) {
  const Trajectory reference = testing::golden_reference();
  Trajectory estimate;
  for (std::size_t i = 0; i < 120; ++i) {
    // Beside the reference's clock: only every sixtieth is within 10 ms.
    const double off_s = i % 60 == 0 ? 0 : 0.03;
    estimate.push_back(geometry::shifted(reference.stamp(i), off_s), reference.pose(i));
  }
  const Evaluation evaluation = evaluate(estimate, reference, run_evaluation_options());
  ASSERT_EQ(evaluation.comparison->warnings.size(), 1U);
  EXPECT_THAT(evaluation.comparison->warnings[0],
              HasSubstr("only 2 of the 120 poses of the estimate found a match within 0.01 s"));
  EXPECT_THAT(to_table(evaluation), HasSubstr("warning      only 2 of the 120"));
  const std::string text = to_json(evaluation);
  EXPECT_EQ(to_json(from_json(text)), text);
  // One match is a point.
  Trajectory one;
  one.push_back(reference.stamp(0), reference.pose(0));
  for (std::size_t i = 1; i < 120; ++i) {
    one.push_back(geometry::shifted(reference.stamp(i), 0.03), reference.pose(i));
  }
  const Comparison c = *evaluate(one, reference, run_evaluation_options()).comparison;
  EXPECT_EQ(c.alignment.reason, "there is one position");
  EXPECT_EQ(c.warnings.size(), 1U);
  // All of a short one, and half of a long one, are enough.
  EXPECT_TRUE(evaluate(testing::golden_estimate(), reference, {}).comparison->warnings.empty());
}

}  // namespace
}  // namespace traverse::evaluation
