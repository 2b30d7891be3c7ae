#include "navigation/frame_queue.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "inertial/chain.hpp"

namespace traverse::inertial {
namespace {

constexpr int kPosition = NavState::kPosition;

/// A standing vehicle with a fix every half second, as Navigation goes about it.
class FrameQueueOfAChain : public ::testing::Test {
 protected:
  void begin(WindowOutput output) {
    queue_ = FrameQueue(output);
    chain_.start({}, sigma());
    queue_.begin(1);
    solve();
  }
  void step() {
    queue_.before_append(chain_);
    chain_.append(testing::coasting(0.5, chain_.newest()));
    queue_.begin(chain_.size());
    solve();
  }
  void solve() {
    chain_.add(testing::fix(Eigen::Vector3d::Zero(), 0.3));
    queue_.take(chain_.solve(), chain_);
  }
  void take_done() {
    for (NavFrame& frame : queue_.take_done()) told_.push_back(std::move(frame));
  }

  static NavState::Tangent sigma() {
    NavState::Tangent sigma = testing::sure_but_of_position(1);
    sigma.segment<3>(NavState::kVelocity).setConstant(0.5);
    return sigma;
  }
  static WindowOptions options() {
    WindowOptions options;
    options.states = 3;
    return options;
  }
  double told_seconds(std::size_t k) const { return told_[k].state.stamp.seconds(); }

  FixedLagSmoother chain_ = testing::smoother(options());
  FrameQueue queue_{WindowOutput::kNewest};
  std::vector<NavFrame> told_;
};

TEST_F(FrameQueueOfAChain, TheNewestIsToldWhenTheNextBegins) {
  begin(WindowOutput::kNewest);
  take_done();
  EXPECT_TRUE(told_.empty()) << "further readings of its moment may join it";
  for (int k = 1; k <= 5; ++k) {
    step();
    take_done();
    ASSERT_EQ(told_.size(), static_cast<std::size_t>(k));
    EXPECT_NEAR(told_seconds(told_.size() - 1), 0.5 * (k - 1), 1e-9);
  }
  queue_.end(chain_);
  take_done();
  EXPECT_EQ(told_.size(), 6U) << "none is lost";
  EXPECT_EQ(told_.back().states, 3);
  EXPECT_TRUE(told_.back().converged);
}

TEST_F(FrameQueueOfAChain, TheOldestIsToldWhenItLeavesTheWindowAndKnowsMore) {
  std::vector<double> sigmas[2];
  for (const WindowOutput output : {WindowOutput::kNewest, WindowOutput::kOldest}) {
    told_.clear();
    begin(output);
    for (int k = 1; k <= 5; ++k) {
      step();
      take_done();
      const int expected = output == WindowOutput::kNewest ? k : std::max(0, k - 2);
      EXPECT_EQ(std::ssize(told_), expected) << k;
    }
    queue_.end(chain_);
    take_done();
    ASSERT_EQ(told_.size(), 6U);
    for (std::size_t k = 0; k < told_.size(); ++k) {
      EXPECT_NEAR(told_seconds(k), 0.5 * static_cast<double>(k), 1e-9);
      sigmas[output == WindowOutput::kOldest].push_back(
          std::sqrt(told_[k].covariance(kPosition, kPosition)));
    }
  }
  for (std::size_t k = 0; k < 5; ++k) EXPECT_LT(sigmas[1][k], 0.9 * sigmas[0][k]) << k;
  EXPECT_NEAR(sigmas[1][5], sigmas[0][5], 1e-9) << "nothing came after the last";
}

TEST_F(FrameQueueOfAChain, SolutionsOfOneStateAddUp) {
  begin(WindowOutput::kNewest);
  const int once = queue_.newest().iterations;
  solve();
  EXPECT_GT(queue_.newest().iterations, once);
  step();
  take_done();
  EXPECT_EQ(told_.size(), 1U) << "it is one frame";
}

TEST_F(FrameQueueOfAChain, AStateThatWasNeverSolvedIsNoFrame) {
  begin(WindowOutput::kNewest);
  queue_.before_append(chain_);
  chain_.append(testing::coasting(0.5, chain_.newest()));
  queue_.begin(chain_.size());
  queue_.end(chain_);
  take_done();
  ASSERT_EQ(told_.size(), 1U);
  EXPECT_EQ(told_seconds(0), 0);
}

TEST_F(FrameQueueOfAChain, FramesBeforeASmootherThatBeganAgainAreTold) {
  begin(WindowOutput::kOldest);
  step();
  step();
  NavState elsewhere = chain_.newest();
  elsewhere.p_map = {100, 0, 0};
  chain_.start(elsewhere, sigma());
  queue_.take(chain_.solve(), chain_);
  take_done();
  ASSERT_EQ(told_.size(), 2U);
  EXPECT_LT(told_[1].state.p_map.norm(), 1) << "what was known of them stays";
  queue_.end(chain_);
  take_done();
  ASSERT_EQ(told_.size(), 3U);
  EXPECT_NEAR(told_[2].state.p_map.x(), 100, 1e-9);
}

}  // namespace
}  // namespace traverse::inertial
