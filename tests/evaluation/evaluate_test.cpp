#include "traverse/evaluation/evaluate.hpp"

#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/evaluation/table.hpp"
#include "traverse/evaluation/titles.hpp"

#include "evaluation/golden_trajectories.hpp"

namespace traverse::evaluation {
namespace {

using geometry::Pose3;
using geometry::Stamp;
using geometry::Trajectory;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Trajectory first_poses(const Trajectory& trajectory, std::size_t count) {
  Trajectory result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(trajectory.stamp(i), trajectory.pose(i));
  return result;
}

Comparison compare(const Trajectory& estimate, const Trajectory& reference,
                   const EvaluationOptions& options = {}) {
  return *evaluate(estimate, reference, options).comparison;
}

TEST(Evaluate, PutsEverythingTogether) {
  EvaluationOptions options = run_evaluation_options();
  const Evaluation evaluation =
      evaluate(testing::golden_estimate(), testing::golden_reference(), options);
  const Comparison& c = *evaluation.comparison;
  EXPECT_EQ(evaluation.estimate.poses, 514U);
  EXPECT_EQ(c.reference.poses, 600U);
  EXPECT_EQ(c.reference.last, Stamp::from_seconds(59.9));
  EXPECT_EQ(c.stamps.size(), 514U);
  EXPECT_EQ(c.distances_m.size(), 514U);
  EXPECT_NEAR(c.distances_m.back(), c.path.reference_m, 1e-12);
  EXPECT_EQ(c.ape.size(), 6U);       // every relation that is absolute
  EXPECT_EQ(c.rpe.size(), 5U * 7U);  // every relation, five deltas
  EXPECT_TRUE(c.undefined.empty());
  ASSERT_TRUE(c.kitti);
  EXPECT_EQ(c.kitti->segments.size(), 131U);
  EXPECT_FALSE(evaluation.consistency);
}

TEST(Evaluate, DriftAndPathAreThoseOfThePosesAsTheyAre) {
  const Trajectory estimate = testing::golden_estimate();
  const Trajectory reference = testing::golden_reference();
  EvaluationOptions sim3;
  sim3.alignment.mode = AlignmentMode::kSim3;
  const Comparison plain = compare(estimate, reference);
  const Comparison scaled = compare(estimate, reference, sim3);
  EXPECT_NE(scaled.alignment.scale, 1);
  EXPECT_EQ(plain.kitti->translation_percent, scaled.kitti->translation_percent);
  EXPECT_EQ(plain.path.end_error_m, scaled.path.end_error_m);
}

TEST(Evaluate, AShortRunListsWhatItDoesNotDefine) {
  const Trajectory estimate = first_poses(testing::golden_estimate(), 30);
  const Comparison c = compare(estimate, testing::golden_reference(), run_evaluation_options());
  std::vector<std::string> metrics;
  for (const Undefined& item : c.undefined) metrics.push_back(item.metric);
  EXPECT_THAT(metrics, ElementsAre("KITTI drift", "RPE, 50 frames, all pairs of the estimate",
                                   "RPE, 100 frames, all pairs of the estimate",
                                   "RPE, 100 m, all pairs of the estimate",
                                   "relative errors over 59.92, 119.84, 179.76, 239.69, 299.61 m"));
  EXPECT_THAT(c.undefined[0].reason, HasSubstr("longer than 100 m: its path is"));
  EXPECT_EQ(c.undefined[1].reason,
            "no pair of poses is 50 frames apart: there are 30 matched poses");
  EXPECT_EQ(c.rpe.size(), 2U * 7U);
  EXPECT_FALSE(c.kitti);
}

TEST(Evaluate, AnRpeThatWasAskedForMustExist) {
  EvaluationOptions options;
  options.rpe = {{{1e6, DeltaUnit::kFrames}, false, PairsFrom::kEstimate}};
  try {
    compare(testing::golden_estimate(), testing::golden_reference(), options);
    FAIL() << "no error";
  } catch (const EvaluationError& error) {
    EXPECT_STREQ(error.what(),
                 "RPE, 1000000 frames, consecutive pairs of the estimate: no consecutive pair of "
                 "poses is 1000000 frames apart: there are 514 matched poses");
  }
}

TEST(Evaluate, ASinglePose) {
  const Trajectory one = first_poses(testing::golden_reference(), 1);
  const Comparison c = compare(one, one, [] {
    EvaluationOptions options = run_evaluation_options();
    options.alignment.mode = AlignmentMode::kOrigin;
    return options;
  }());
  EXPECT_EQ(c.ape[0].values.size(), 1U);
  EXPECT_TRUE(c.rpe.empty());
  EXPECT_FALSE(c.path.end_error_percent);
}

TEST(Evaluate, IdenticalTrajectoriesHaveNoError) {
  const Trajectory reference = testing::golden_reference();
  const Comparison c = compare(reference, reference, run_evaluation_options());
  for (const Ape& ape : c.ape) EXPECT_LT(ape.statistics.max, 1e-6) << name_of(ape.relation);
  EXPECT_LT(c.kitti->translation_percent, 1e-9);
  EXPECT_EQ(c.path.end_error_m, 0);
}

TEST(Evaluate, RefusesPosesThatAreNotFinite) {
  const Trajectory reference = first_poses(testing::golden_reference(), 10);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), 1e200}) {
    Trajectory estimate = first_poses(reference, 9);
    Pose3 pose;
    pose.translation.z() = bad;
    estimate.push_back(reference.stamp(9), pose);
    EXPECT_THROW(compare(estimate, reference), EvaluationError) << bad;
    EXPECT_THROW(evaluate(estimate), EvaluationError) << bad;
  }
}

TEST(Titles, SayHowAFigureWasMade) {
  EvaluationOptions options;
  options.alignment = {AlignmentMode::kSim3, 50};
  options.rpe = {{{10, DeltaUnit::kFrames}, false, PairsFrom::kEstimate}};
  const Comparison c = compare(testing::golden_estimate(), testing::golden_reference(), options);
  EXPECT_EQ(title(c.ape[0], c),
            "APE translation part, Sim(3) alignment on the first 50 poses, scale 0.979465, 514 "
            "pairs, by evo's rule");
  EXPECT_THAT(title(c.rpe[0], c),
              HasSubstr("RPE translation part, 10 frames, consecutive pairs of the estimate, "));
  EXPECT_THAT(title(c.rpe[0], c), HasSubstr(", 51 pairs, by evo's rule"));
  EXPECT_EQ(describe(c.association), "514 pairs by stamp, at most 0.01 s apart");
  EXPECT_EQ(
      title(*c.kitti),
      "KITTI drift, body frame, no alignment, 131 segments of 100 to 800 m, one start every 10 "
      "poses, 0.1 s per pose, by the rule of KITTI's devkit");
}

TEST(Table, ShowsEveryFigureWithUnitAndOrigin) {
  EvaluationOptions options;
  options.alignment.mode = AlignmentMode::kSe3;
  options.rpe = {{{10, DeltaUnit::kFrames}, false, PairsFrom::kEstimate}};
  const std::string table =
      to_table(evaluate(testing::golden_estimate(), testing::golden_reference(), options));
  for (const char* part :
       {"514 pairs by stamp, at most 0.01 s apart", "APE, SE(3) alignment",
        "translation part [m]           2.0087     2.0087     2.0086", "rotation angle [deg]",
        "RPE, 10 frames, consecutive pairs of the estimate, SE(3) alignment", "2.1116", "deg/m",
        "path of the reference"}) {
    EXPECT_THAT(table, HasSubstr(part));
  }
}

}  // namespace
}  // namespace traverse::evaluation
