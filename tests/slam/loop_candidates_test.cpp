#include "traverse/slam/loop_candidates.hpp"

#include <gtest/gtest.h>

namespace traverse::slam {
namespace {

/// A drive along x, a keyframe every 2 m.
LoopCandidates straight_drive(std::size_t keyframes) {
  CandidateOptions options;
  options.least_way_m = 40;
  LoopCandidates candidates(options);
  for (std::size_t i = 0; i < keyframes; ++i) {
    const double x = 2 * static_cast<double>(i);
    candidates.add(ScanContext({}, {}, {}, options.context), x, {x, 0, 0});
  }
  return candidates;
}

TEST(LoopCandidates, ThePresentSurroundingsAreNoLoop) {
  const LoopCandidates candidates = straight_drive(51);
  EXPECT_EQ(candidates.findable(), 31U);  // those at least 40 m behind
  EXPECT_FALSE(candidates.by_position({100, 0, 0}, 10).has_value());
}

TEST(LoopCandidates, TheNearestWithinReach) {
  const LoopCandidates candidates = straight_drive(51);
  const auto near = candidates.by_position({20.7, 3, 0}, 5);
  ASSERT_TRUE(near.has_value());
  EXPECT_EQ(near->keyframe, 10U);
  EXPECT_FALSE(candidates.by_position({20.7, 6, 0}, 5).has_value());
}

TEST(LoopCandidates, FollowsTheSolvedPositions) {
  LoopCandidates candidates = straight_drive(51);
  std::vector<Eigen::Vector3d> moved;
  for (int i = 0; i < 51; ++i) moved.emplace_back(2.0 * i, 30, 0);
  candidates.move(moved);
  EXPECT_FALSE(candidates.by_position({20, 0, 0}, 10).has_value());
  EXPECT_EQ(candidates.by_position({20, 29, 0}, 10)->keyframe, 10U);
}

}  // namespace
}  // namespace traverse::slam
