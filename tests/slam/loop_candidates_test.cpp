#include "traverse/slam/loop_candidates.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace traverse::slam {
namespace {

/// A drive along x, a keyframe every 2 m.
LoopCandidates straight_drive(std::size_t keyframes) {
  CandidateOptions options;
  options.min_way_m = 40;
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

/// Whether they moved by less than the index is made anew for, or by more.
TEST(LoopCandidates, TheNearestIsThatOfThePresentPositions) {
  LoopCandidates candidates = straight_drive(200);
  std::mt19937 random(3);
  for (const double max_m : {0.1, 0.9, 0.9, 6.0, 0.5}) {
    std::uniform_real_distribution<double> move(-max_m / 2, max_m / 2);
    std::vector<Eigen::Vector3d> p_map;
    for (int i = 0; i < 200; ++i) p_map.emplace_back(2.0 * i + move(random), move(random), 0);
    candidates.move(p_map);
    for (double x = -3; x < 370; x += 0.7) {
      const Eigen::Vector3d asked(x, 1, 0);
      const auto distance_m = [&](std::size_t i) { return (p_map[i] - asked).norm(); };
      std::size_t nearest = 0;
      for (std::size_t i = 1; i < candidates.findable(); ++i) {
        if (distance_m(i) < distance_m(nearest)) nearest = i;
      }
      const auto found = candidates.by_position(asked, 2.5);
      EXPECT_EQ(found.has_value(), distance_m(nearest) <= 2.5) << x;
      if (found) {
        EXPECT_EQ(found->keyframe, nearest) << x;
      }
    }
  }
}

}  // namespace
}  // namespace traverse::slam
