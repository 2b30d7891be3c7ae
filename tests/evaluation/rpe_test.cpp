#include "traverse/evaluation/rpe.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/evaluation/evaluation_error.hpp"
#include "traverse/geometry/so3.hpp"

namespace traverse::evaluation {
namespace {

using geometry::Pose3;
using PoseList = std::vector<Pose3>;
using ::testing::ElementsAre;

PoseList on_axis(const std::vector<double>& x_m) {
  PoseList poses;
  for (const double x : x_m) poses.push_back({Eigen::Matrix3d::Identity(), {x, 0, 0}});
  return poses;
}

constexpr RpeOptions kOneFrame{{1, DeltaUnit::kFrames}, false, PairsFrom::kEstimate};

std::string message_of(const RpeOptions& options) {
  try {
    rpe(on_axis({0, 1, 2}), on_axis({0, 1, 3}), options, Relation::kTranslation);
  } catch (const EvaluationError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Rpe, IsTheErrorOfEachMotion) {
  const Rpe found =
      rpe(on_axis({0, 1, 2.5}), on_axis({7, 8, 9}), kOneFrame, Relation::kTranslation);
  EXPECT_THAT(found.values, ElementsAre(0, 0.5));
  EXPECT_EQ(found.statistics.count, 2U);
}

TEST(Rpe, TheSourceOfThePairsIsAChoice) {
  const PoseList estimate = on_axis({0, 1, 2, 3, 4});
  const PoseList reference = on_axis({0, 2, 4, 6, 8});
  RpeOptions options{{2, DeltaUnit::kMetres}, true, PairsFrom::kEstimate};
  EXPECT_EQ(rpe(estimate, reference, options, Relation::kTranslation).pairs[0].to, 2U);
  options.pairs_from = PairsFrom::kReference;
  EXPECT_EQ(rpe(estimate, reference, options, Relation::kTranslation).pairs[0].to, 1U);
}

TEST(Rpe, SaysWhatThereIsWhenThereIsNoPair) {
  EXPECT_EQ(message_of({{3, DeltaUnit::kFrames}, true, PairsFrom::kEstimate}),
            "no pair of poses is 3 frames apart: there are 3 matched poses");
  EXPECT_EQ(message_of({{100, DeltaUnit::kMetres}, false, PairsFrom::kReference}),
            "no consecutive pair of poses is 100 m apart: the path of the reference is 3 m long");
  EXPECT_EQ(message_of({{5, DeltaUnit::kDegrees}, false, PairsFrom::kEstimate}),
            "no consecutive pair of poses is 5 deg apart: the estimate turns by 0 deg in all");
}

TEST(Rpe, RatiosWithoutMotionOfTheReferenceAreDroppedAndCounted) {
  const PoseList estimate = on_axis({0, 1, 2, 4});
  const Rpe found = rpe(estimate, on_axis({0, 1, 1, 3}), kOneFrame, Relation::kPointDistanceRatio);
  EXPECT_EQ(found.dropped_without_motion, 1U);
  EXPECT_THAT(found.pairs, ElementsAre(IndexPair{0, 1}, IndexPair{2, 3}));
  EXPECT_THAT(found.values, ElementsAre(0, 0));
  // The distance itself is defined there.
  EXPECT_THAT(rpe(estimate, on_axis({0, 1, 1, 3}), kOneFrame, Relation::kPointDistance).values,
              ElementsAre(0, 1, 0));
  EXPECT_THROW(rpe(estimate, on_axis({1, 1, 1, 1}), kOneFrame, Relation::kPointDistanceRatio),
               EvaluationError);
}

}  // namespace
}  // namespace traverse::evaluation
