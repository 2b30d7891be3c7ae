#include "traverse/evaluation/pose_pairs.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/evaluation/path_figures.hpp"
#include "traverse/geometry/so3.hpp"

#include "geometry/random_motion.hpp"

namespace traverse::evaluation {

void PrintTo(const IndexPair& pair, std::ostream* stream) {
  *stream << "(" << pair.from << ", " << pair.to << ")";
}

namespace {

using geometry::Pose3;
using LinePoses = std::vector<Pose3>;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Poses on the x axis at `x_m`.
LinePoses line_on_axis(const std::vector<double>& x_m) {
  LinePoses poses;
  for (const double x : x_m) poses.push_back({Eigen::Matrix3d::Identity(), {x, 0, 0}});
  return poses;
}

/// Poses turned about z by `angles_deg`.
LinePoses turned(const std::vector<double>& angles_deg) {
  LinePoses poses;
  for (const double angle : angles_deg) {
    poses.push_back({geometry::exp_so3({0, 0, angle * std::numbers::pi / 180}), {0, 0, 0}});
  }
  return poses;
}

LinePoses random_walk(unsigned seed, int count) {
  testing::RandomMotion random(seed);
  LinePoses poses{Pose3()};
  for (int i = 1; i < count; ++i) {
    // Stands still now and then, so that several poses share one distance.
    poses.push_back(i % 5 == 0 ? poses.back() : poses.back() * random.pose(0.3, 1));
  }
  return poses;
}

constexpr Delta kTwoFrames{2, DeltaUnit::kFrames};

TEST(PosePairs, Frames) {
  const LinePoses poses = line_on_axis({0, 1, 2, 3, 4, 5});
  EXPECT_THAT(select_pairs(poses, kTwoFrames, false),
              ElementsAre(IndexPair{0, 2}, IndexPair{2, 4}));
  EXPECT_THAT(select_pairs(poses, kTwoFrames, true),
              ElementsAre(IndexPair{0, 2}, IndexPair{1, 3}, IndexPair{2, 4}, IndexPair{3, 5}));
  EXPECT_THAT(select_pairs(poses, {6, DeltaUnit::kFrames}, true), IsEmpty());
  EXPECT_THAT(select_pairs(poses, {1e15, DeltaUnit::kFrames}, true), IsEmpty());
}

TEST(PosePairs, ConsecutiveMetresBeginAtTheFirstRecordedIndex) {
  // 2 m are full at 2, 5 and 6: the stretch from index 0 to the first is no pair.
  const LinePoses poses = line_on_axis({0, 1, 2, 2.5, 3, 4.5, 7, 8});
  EXPECT_THAT(select_pairs(poses, {2, DeltaUnit::kMetres}, false),
              ElementsAre(IndexPair{2, 5}, IndexPair{5, 6}));
  EXPECT_THAT(select_pairs(poses, {5, DeltaUnit::kMetres}, false), IsEmpty());
}

TEST(PosePairs, AllMetresTakeTheNearestWithinATenth) {
  EXPECT_THAT(select_pairs(line_on_axis({0, 1.79, 2.15, 2.2, 9}), {2, DeltaUnit::kMetres}, true),
              ElementsAre(IndexPair{0, 2}));
  // Equally near and standing still: the first.
  EXPECT_THAT(select_pairs(line_on_axis({0, 1.875, 2.125}), {2, DeltaUnit::kMetres}, true),
              ElementsAre(IndexPair{0, 1}));
  EXPECT_THAT(select_pairs(line_on_axis({0, 2, 2, 2}), {2, DeltaUnit::kMetres}, true),
              ElementsAre(IndexPair{0, 1}));
}

TEST(PosePairs, AllMetresAreWhatTheDefinitionSays) {
  const LinePoses poses = random_walk(1, 300);
  const auto path_m = accumulated_distances(poses);
  std::vector<IndexPair> expected;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    std::size_t best = i + 1;
    for (std::size_t j = i + 1; j < poses.size(); ++j) {
      if (std::abs(path_m[j] - path_m[i] - 4) < std::abs(path_m[best] - path_m[i] - 4)) best = j;
    }
    if (std::abs(path_m[best] - path_m[i] - 4) <= 0.4) expected.push_back({i, best});
  }
  ASSERT_GT(expected.size(), 100U);
  EXPECT_EQ(select_pairs(poses, {4, DeltaUnit::kMetres}, true), expected);
}

TEST(PosePairs, ConsecutiveAnglesBeginAtIndexZero) {
  const LinePoses poses = turned({0, 3, 6, 2, 1, -4, -5});
  // 6 deg at 2; 4 + 1 + 5 at 5.
  EXPECT_THAT(select_pairs(poses, {5, DeltaUnit::kDegrees}, false),
              ElementsAre(IndexPair{0, 2}, IndexPair{2, 4}, IndexPair{4, 5}));
  EXPECT_THAT(select_pairs(poses, {5 * std::numbers::pi / 180, DeltaUnit::kRadians}, false).size(),
              3U);
}

TEST(PosePairs, AllAnglesAreDirectOnes) {
  EXPECT_THAT(select_pairs(turned({0, 30, 60, 0, 61}), {60, DeltaUnit::kDegrees}, true),
              ElementsAre(IndexPair{0, 2}, IndexPair{0, 4}, IndexPair{2, 3}, IndexPair{3, 4}));
  EXPECT_THAT(select_pairs(turned({0, 175, 180}), {180, DeltaUnit::kDegrees}, true),
              ElementsAre(IndexPair{0, 1}, IndexPair{0, 2}));
}

TEST(PosePairs, AllAnglesAreWhatTheDefinitionSays) {
  const LinePoses poses = random_walk(2, 300);
  std::vector<IndexPair> expected;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t j = i + 1; j < poses.size(); ++j) {
      const double angle = geometry::angle_of(poses[i].rotation.transpose() * poses[j].rotation);
      if (std::abs(angle - 0.5) <= 0.05) expected.push_back({i, j});
    }
  }
  ASSERT_GT(expected.size(), 100U);
  EXPECT_EQ(select_pairs(poses, {0.5, DeltaUnit::kRadians}, true), expected);
}

TEST(PosePairs, OnePoseHasNoPair) {
  for (const auto& [name, unit] : kDeltaUnitNames) {
    for (const bool all_pairs : {false, true}) {
      EXPECT_THAT(select_pairs(line_on_axis({0}), {1, unit}, all_pairs), IsEmpty()) << name;
      EXPECT_THAT(select_pairs({}, {1, unit}, all_pairs), IsEmpty()) << name;
    }
  }
}

TEST(Delta, ReadsNumberAndUnit) {
  EXPECT_EQ(parse_delta("10f")->value, 10);
  EXPECT_EQ(parse_delta("2.5m")->unit, DeltaUnit::kMetres);
  EXPECT_EQ(parse_delta("5deg")->unit, DeltaUnit::kDegrees);
  EXPECT_EQ(to_text(*parse_delta("0.1rad")), "0.1 rad");
  EXPECT_EQ(to_text(*parse_delta("1f")), "1 frame");
  for (const char* text : {"", "10", "f", "0f", "1.5f", "-1m", "0m", "infm", "nanm", "181deg",
                           "4rad", "1 m", "1mm", "-1f"}) {
    EXPECT_FALSE(parse_delta(text)) << text;
  }
  EXPECT_THROW(select_pairs(line_on_axis({0, 1}), {1.5, DeltaUnit::kFrames}, true),
               std::invalid_argument);
}

}  // namespace
}  // namespace traverse::evaluation
