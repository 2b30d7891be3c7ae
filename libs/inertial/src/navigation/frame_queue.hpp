#pragma once

#include <deque>
#include <vector>

#include "traverse/inertial/navigation.hpp"

#include "smoother/fixed_lag_smoother.hpp"

namespace traverse::inertial {

/// The frames of the states in the window, and those that are complete: when a later state begins
/// or, smoothed, when a state leaves the window.
class FrameQueue {
 public:
  explicit FrameQueue(WindowOutput output) : output_(output) {}

  NavFrame& newest() { return waiting_.back(); }
  const NavFrame& newest() const { return waiting_.back(); }

  /// Keeps what is known of states that may leave the window now.
  void before_append(const FixedLagSmoother& smoother);
  /// A frame for the newest of now `states` states.
  void begin(std::size_t states);
  /// What a solution says of the states.
  void take(const FixedLagSmoother::Solution& solution, const FixedLagSmoother& smoother);
  /// All frames are complete.
  void end(const FixedLagSmoother& smoother);

  std::vector<NavFrame> take_done();

 private:
  void complete(std::size_t kept);
  void keep_covariances(const FixedLagSmoother& smoother);

  WindowOutput output_;
  std::deque<NavFrame> waiting_;
  std::vector<NavFrame> done_;
};

}  // namespace traverse::inertial
