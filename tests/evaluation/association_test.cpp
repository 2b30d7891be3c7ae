#include "traverse/evaluation/association.hpp"

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/evaluation/evaluation_error.hpp"

namespace traverse::evaluation {
namespace {

using geometry::Pose3;
using geometry::Stamp;
using geometry::Trajectory;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

/// Stamps in seconds; the pose does not matter.
Trajectory at(const std::vector<double>& seconds) {
  Trajectory trajectory;
  for (const double s : seconds) trajectory.push_back(Stamp::from_seconds(s), Pose3());
  return trajectory;
}

/// (estimate, reference) of each match.
std::vector<std::pair<std::size_t, std::size_t>> indices(const Association& association) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const Match& match : association.matches) {
    pairs.emplace_back(match.estimate, match.reference);
  }
  return pairs;
}

std::string message_of(const Trajectory& estimate, const Trajectory& reference,
                       const AssociationOptions& options = {}) {
  try {
    associate(estimate, reference, options);
  } catch (const EvaluationError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Association, TakesTheNearestWithinTheLimitItself) {
  const Association found = associate(at({1.01, 2.0, 3.011}), at({1, 1.5, 2, 2.5, 3}), {});
  EXPECT_THAT(indices(found), ElementsAre(Pair(0, 0), Pair(1, 2)));
  EXPECT_DOUBLE_EQ(found.matches[0].time_difference_s, 0.01);
  EXPECT_DOUBLE_EQ(found.largest_time_difference_s(), 0.01);
}

TEST(Association, TheShorterTrajectoryDrives) {
  // Two poses of the estimate share one of the reference only when the estimate drives.
  const Trajectory estimate = at({1.000, 1.004});
  EXPECT_THAT(indices(associate(estimate, at({1.001, 5, 6}), {})),
              ElementsAre(Pair(0, 0), Pair(1, 0)));
  EXPECT_THAT(indices(associate(estimate, at({1.001}), {})), ElementsAre(Pair(0, 0)));
  // Of two equally long ones the estimate drives.
  EXPECT_THAT(indices(associate(estimate, at({1.001, 5}), {})),
              ElementsAre(Pair(0, 0), Pair(1, 0)));
}

TEST(Association, TakesTheFirstOfEquallyNear) {
  EXPECT_THAT(indices(associate(at({1.005}), at({1.0, 1.01}), {})), ElementsAre(Pair(0, 0)));
  // Identical stamps, on either side of the nearest time.
  EXPECT_THAT(indices(associate(at({1.0, 1.0}), at({0.999, 0.999, 5}), {})),
              ElementsAre(Pair(0, 0), Pair(1, 0)));
  EXPECT_THAT(indices(associate(at({1.0}), at({1.002, 1.002}), {})), ElementsAre(Pair(0, 0)));
  EXPECT_THAT(indices(associate(at({1.0}), at({0.5, 1.0, 1.0}), {})), ElementsAre(Pair(0, 1)));
}

TEST(Association, NanosecondsDecideAlsoAtUnixTime) {
  const std::int64_t t = 1317042145'000'000'000;
  const auto single = [](std::int64_t nanoseconds) {
    return Trajectory::stamped({Stamp{nanoseconds}}, {Pose3()});
  };
  EXPECT_EQ(associate(single(t + 10'000'000), single(t), {}).matches.size(), 1U);
  EXPECT_THROW(associate(single(t + 10'000'001), single(t), {}), EvaluationError);
}

TEST(Association, AddsTheOffsetToTheEstimate) {
  AssociationOptions options;
  options.time_offset_s = -99.5;
  const Association found = associate(at({100.501, 101.5}), at({1, 2, 3}), options);
  EXPECT_THAT(indices(found), ElementsAre(Pair(0, 0), Pair(1, 1)));
  EXPECT_NEAR(found.matches[0].time_difference_s, 0.001, 1e-12);
}

TEST(Association, SaysBothSpansAndTheClosestDifferenceWhenNothingFits) {
  EXPECT_EQ(message_of(at({1, 2}), at({10, 20, 30})),
            "no pose of the estimate is within 0.01 s of a pose of the reference: the estimate "
            "spans 1.000000000 to 2.000000000 s, the reference 10.000000000 to 30.000000000 s, the "
            "closest two are 8 s apart");
  AssociationOptions options;
  options.time_offset_s = 3;
  EXPECT_THAT(message_of(at({1, 2}), at({10, 20, 30}), options),
              HasSubstr("(before the offset of 3 s), the reference 10.000000000 to 30.000000000 s, "
                        "the closest two are 5 s apart"));
}

TEST(Association, ExtremeStampsDoNotOverflow) {
  const auto most = std::numeric_limits<std::int64_t>::max();
  const auto least = std::numeric_limits<std::int64_t>::min();
  const Trajectory late = Trajectory::stamped({Stamp{most}}, {Pose3()});
  const Trajectory early = Trajectory::stamped({Stamp{least + 1}}, {Pose3()});
  EXPECT_THAT(message_of(late, early), HasSubstr("1844674407"));
  AssociationOptions options;
  options.time_offset_s = 9e9;
  EXPECT_THAT(message_of(late, early, options), HasSubstr("no pose"));
}

TEST(Association, WithoutStampsGoesByIndexAndNeedsEqualCounts) {
  const Trajectory two = Trajectory::unstamped({Pose3(), Pose3()});
  const Trajectory three = Trajectory::unstamped({Pose3(), Pose3(), Pose3()});
  const Association found = associate(two, two, {});
  EXPECT_EQ(found.mode, AssociationMode::kIndex);
  EXPECT_THAT(indices(found), ElementsAre(Pair(0, 0), Pair(1, 1)));
  EXPECT_THAT(message_of(two, three), HasSubstr("the estimate has 2, the reference 3"));
  EXPECT_THAT(message_of(two, at({1, 2})), HasSubstr("the reference has stamps and the estimate"));
  AssociationOptions options;
  options.time_offset_s = 1;
  EXPECT_THAT(message_of(two, two, options), HasSubstr("a time offset needs"));
}

TEST(Association, RefusesEmptyAndBackwardTrajectories) {
  EXPECT_EQ(message_of(Trajectory(), at({1})), "the estimate has no pose");
  EXPECT_EQ(message_of(at({1}), Trajectory()), "the reference has no pose");
  EXPECT_EQ(message_of(at({1, 3, 2}), at({1, 2, 3})),
            "the stamps of the estimate go back at pose 2: 2.000000000 s after 3.000000000 s");
}

TEST(Association, RefusesOptionsThatAreNoTimes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(associate(at({1}), at({1}), {-1, 0}), std::invalid_argument);
  EXPECT_THROW(associate(at({1}), at({1}), {nan, 0}), std::invalid_argument);
  EXPECT_THROW(associate(at({1}), at({1}), {0.01, nan}), std::invalid_argument);
  EXPECT_THROW(associate(at({1}), at({1}), {0.01, 1e300}), std::invalid_argument);
}

TEST(Association, MatchedPosesFollowTheMatches) {
  Trajectory estimate;
  Trajectory reference;
  for (int i = 0; i < 5; ++i) {
    Pose3 pose;
    pose.translation.x() = i;
    reference.push_back(Stamp::from_seconds(i), pose);
    if (i % 2 == 1) estimate.push_back(Stamp::from_seconds(i), pose);
  }
  const Association association = associate(estimate, reference, {});
  const MatchedPoses poses = matched_poses(estimate, reference, association.matches);
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses.estimate[1].translation.x(), 3);
  EXPECT_EQ(poses.reference[1].translation.x(), 3);
}

}  // namespace
}  // namespace traverse::evaluation
