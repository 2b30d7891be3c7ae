#include "traverse/replay/checkpoints.hpp"

#include <gtest/gtest.h>

#include "traverse/replay/path_estimator.hpp"

namespace traverse::replay {
namespace {

Checkpoint at(std::size_t frame) {
  Checkpoint checkpoint;
  checkpoint.state.next_frame = frame;
  checkpoint.state.estimator = std::make_unique<PathEstimator>("wheels");
  return checkpoint;
}

TEST(Checkpoints, StayBoundedAndDenseNearThePresent) {
  Checkpoints checkpoints;
  for (std::size_t frame = 0; frame <= 10000; frame += 10) checkpoints.add(at(frame));
  const std::vector<std::size_t> frames = checkpoints.frames();
  EXPECT_EQ(frames.size(), Checkpoints::kMost);
  EXPECT_EQ(frames.front(), 0U);
  EXPECT_EQ(frames.back(), 10000U);
  EXPECT_LE(10000U - frames[frames.size() - 2], 30U);
  // The way to any frame stays short against the way back to it from the present.
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_LE(frames[i] - frames[i - 1], 20 + (10000 - frames[i - 1])) << frames[i];
  }
  EXPECT_LE(frames[frames.size() - 2] - frames[frames.size() - 8], 2000U);
}

TEST(Checkpoints, TheOneBeforeAFrameIsTheNearest) {
  Checkpoints checkpoints;
  EXPECT_EQ(checkpoints.before(5), nullptr);
  for (std::size_t frame : {0U, 10U, 20U}) checkpoints.add(at(frame));
  EXPECT_EQ(checkpoints.before(9)->state.next_frame, 0U);
  EXPECT_EQ(checkpoints.before(10)->state.next_frame, 10U);
  EXPECT_EQ(checkpoints.before(500)->state.next_frame, 20U);
}

}  // namespace
}  // namespace traverse::replay
