#include "traverse/evaluation/association.hpp"

#include <cstdint>
#include <limits>
#include <numeric>
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
  const Association found = associate(at({1.25, 2.0, 3.26}), at({1, 1.5, 2, 2.5, 3}), {0.25, 0});
  EXPECT_THAT(indices(found), ElementsAre(Pair(0, 0), Pair(1, 2)));
  EXPECT_DOUBLE_EQ(found.matches[0].time_difference_s, 0.25);
  EXPECT_DOUBLE_EQ(found.largest_time_difference_s(), 0.25);
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

/// Stamps of 0.1 s, moved by `shift_us`, from a Unix time on.
Trajectory at_unix_time(std::int64_t shift_us, std::size_t poses) {
  Trajectory trajectory;
  for (std::size_t k = 0; k < poses; ++k) {
    trajectory.push_back(
        Stamp{1317042145'000'000'000 + 1000 * (shift_us + 100'000 * static_cast<std::int64_t>(k))},
        Pose3());
  }
  return trajectory;
}

std::vector<std::size_t> references_of(const Association& association) {
  std::vector<std::size_t> numbers;
  for (const Match& match : association.matches) numbers.push_back(match.reference);
  return numbers;
}

TrajectoryView in_nanoseconds(const Trajectory& trajectory) {
  TrajectoryView view(trajectory);
  view.times = TimesInFile::kNanoseconds;
  return view;
}

// Half way between two stamps, which of them is nearest only the rounding of doubles tells. What
// evo (1.36.5, matching_time_indices) gives for these times in a TUM and in a EuRoC file.
TEST(Association, TiesAtUnixTimeAreThoseOfEvo) {
  const std::vector<std::size_t> of_seconds{0,  2,  2,  3,  4,  5,  7,  7,  8,  9,  10, 12, 12,
                                            13, 14, 15, 17, 17, 18, 19, 20, 22, 22, 23, 24, 25,
                                            27, 27, 28, 29, 30, 32, 32, 33, 34, 35, 37, 37, 38};
  const std::vector<std::size_t> of_nanoseconds{0,  2,  2,  4,  4,  6,  6,  8,  8,  9,  10, 12, 12,
                                                14, 14, 16, 16, 18, 18, 19, 20, 22, 22, 24, 24, 26,
                                                26, 28, 28, 29, 30, 32, 32, 34, 34, 36, 36, 38, 38};
  const Trajectory estimate = at_unix_time(50'000, 39);
  const Trajectory reference = at_unix_time(0, 40);
  EXPECT_EQ(references_of(associate(estimate, reference, {0.06, 0})), of_seconds);
  // evo adds the offset to the longer one, as doubles: then the ties are others.
  std::vector<std::size_t> first_of_two(39);
  std::iota(first_of_two.begin(), first_of_two.end(), std::size_t{0});
  EXPECT_EQ(references_of(associate(at_unix_time(-250'000, 39), reference, {0.06, 0.3})),
            first_of_two);
  EXPECT_EQ(
      references_of(associate(in_nanoseconds(estimate), in_nanoseconds(reference), {0.06, 0})),
      of_nanoseconds);
  EXPECT_EQ(references_of(associate(in_nanoseconds(estimate), reference, {0.06, 0})),
            of_nanoseconds);
}

TEST(Association, TheLimitIsComparedAsEvoDoes) {
  // 10 ms apart to the nanosecond, and a little less as doubles of seconds.
  EXPECT_EQ(associate(at_unix_time(10'000, 40), at_unix_time(0, 40), {}).matches.size(), 40U);
  // 0.41 - 0.4 is less than 0.01 as doubles, 0.31 - 0.3 is more.
  std::vector<double> tenths;
  std::vector<double> later;
  for (int k = 0; k < 20; ++k) {
    tenths.push_back(0.1 * k);
    later.push_back(0.1 * k + 0.01);
  }
  EXPECT_EQ(references_of(associate(at(later), at(tenths), {})),
            (std::vector<std::size_t>{0, 1, 2, 4}));
  EXPECT_EQ(associate(at(later), at(tenths), {0.0100001, 0}).matches.size(), 20U);
}

// So far from zero that doubles do not tell nanoseconds apart: of all those the first, and quickly.
TEST(Association, OfStampsThatDoublesDoNotTellApartTheFirstIsTaken) {
  std::vector<Stamp> stamps;
  for (std::int64_t k = 0; k < 100'000; ++k) stamps.push_back(Stamp{1317042145'000'000'000 + k});
  const Trajectory reference =
      Trajectory::stamped(stamps, std::vector<Pose3>(stamps.size(), Pose3()));
  const Association found = associate(at_unix_time(10'000, 1000), reference, {1e6, 0});
  EXPECT_EQ(found.matches.size(), 1000U);
  EXPECT_EQ(found.matches[0].reference, 99'779U);
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
