#include "traverse/replay/controls.hpp"

#include <gtest/gtest.h>

namespace traverse::replay {
namespace {

class ControlsTest : public ::testing::Test {
 protected:
  ControlsTest() {
    for (int i = 0; i < 100; ++i) timeline_.add(geometry::Stamp::from_seconds(0.1 * i));
    timeline_.set_complete();
  }

  /// Lets time pass in steps of 10 ms with an estimator that is quick.
  std::size_t run(double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * 100 + 0.5); ++i) {
      shown_ = controls_.advance(0.01, shown_, timeline_);
    }
    return shown_;
  }

  Timeline timeline_;
  Controls controls_;
  std::size_t shown_ = 0;
};

TEST_F(ControlsTest, NothingMovesUntilItPlays) { EXPECT_EQ(run(2), 0U); }

TEST_F(ControlsTest, PlaysAtThePaceOfTheStamps) {
  controls_.play();
  EXPECT_NEAR(static_cast<double>(run(2)), 20, 1);
  controls_.set_speed(4);
  EXPECT_NEAR(static_cast<double>(run(1)), 60, 2);
  controls_.set_speed(0.5);
  EXPECT_NEAR(static_cast<double>(run(2)), 70, 3);
  controls_.pause();
  EXPECT_EQ(run(1), shown_);
}

TEST_F(ControlsTest, SpeedsAreBounded) {
  controls_.set_speed(1000);
  EXPECT_EQ(controls_.speed(), Controls::kFastest);
  controls_.set_speed(0);
  EXPECT_EQ(controls_.speed(), Controls::kSlowest);
}

TEST_F(ControlsTest, ASlowEstimatorSetsThePaceAndNothingIsCaughtUp) {
  controls_.play();
  controls_.set_speed(16);
  for (int i = 0; i < 100; ++i) controls_.advance(0.01, 3, timeline_);  // one second at frame 3
  EXPECT_LE(controls_.wanted_in(timeline_), 3U + 4U);
  controls_.set_speed(1);
  shown_ = controls_.wanted_in(timeline_);
  const std::size_t from = shown_;
  EXPECT_NEAR(static_cast<double>(run(1) - from), 10, 1);
}

TEST_F(ControlsTest, AsFastAsPossibleIsFrameByFrame) {
  controls_.play();
  controls_.set_unlimited(true);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(controls_.advance(0, i, timeline_), i + 1);
  }
}

TEST_F(ControlsTest, PausesAtTheEndOrBeginsAgain) {
  controls_.play();
  controls_.seek(95);
  EXPECT_EQ(run(2), 99U);
  EXPECT_FALSE(controls_.playing());
  controls_.set_loop(true);
  controls_.play();
  run(0.02);
  EXPECT_TRUE(controls_.playing());
  EXPECT_LT(run(0.5), 10U);
}

TEST_F(ControlsTest, ARangeHoldsPlayingButNotSeeking) {
  controls_.set_range(30, 20);  // given the wrong way round
  controls_.play();
  run(0.02);
  EXPECT_EQ(shown_, 20U);
  run(3);
  EXPECT_EQ(shown_, 30U);
  EXPECT_FALSE(controls_.playing());
  controls_.seek(70);
  EXPECT_EQ(run(0.1), 70U);
  controls_.home();
  EXPECT_EQ(run(0.1), 20U);
  controls_.end();
  EXPECT_EQ(run(0.1), 30U);
}

TEST_F(ControlsTest, StepsPauseAndStayWithinTheRecording) {
  controls_.play();
  controls_.step(10);
  EXPECT_FALSE(controls_.playing());
  EXPECT_EQ(run(0.1), 10U);
  controls_.step(-1000);
  EXPECT_EQ(run(0.1), 0U);
  controls_.seek(98);
  controls_.step(10);
  EXPECT_EQ(run(0.1), 99U);
  controls_.step(-1);
  EXPECT_EQ(run(0.1), 98U);
}

TEST_F(ControlsTest, NothingBeforeTheOrigin) {
  controls_.set_origin(40);
  EXPECT_EQ(run(0.1), 40U);
  controls_.home();
  EXPECT_EQ(run(0.1), 40U);
  controls_.seek(5);
  EXPECT_EQ(run(0.1), 40U);
}

TEST_F(ControlsTest, TheEndIsWaitedForWhileTheIndexGrows) {
  Timeline growing;
  for (int i = 0; i < 10; ++i) growing.add(geometry::Stamp::from_seconds(i));
  controls_.end();
  EXPECT_EQ(controls_.advance(0, 0, growing), 9U);
  EXPECT_FALSE(controls_.is_settled(9, growing));
  growing.add(geometry::Stamp::from_seconds(10));
  EXPECT_EQ(controls_.advance(0, 9, growing), 10U);
  growing.set_complete();
  EXPECT_EQ(controls_.advance(0, 10, growing), 10U);
  EXPECT_TRUE(controls_.is_settled(10, growing));
}

TEST_F(ControlsTest, LongGapsArePassedQuickly) {
  Timeline gap;
  gap.add(geometry::Stamp::from_seconds(0));
  gap.add(geometry::Stamp::from_seconds(3600));
  gap.set_complete();
  controls_.play();
  for (int i = 0; i < 110; ++i) shown_ = controls_.advance(0.01, shown_, gap);
  EXPECT_EQ(shown_, 1U);
}

}  // namespace
}  // namespace traverse::replay
