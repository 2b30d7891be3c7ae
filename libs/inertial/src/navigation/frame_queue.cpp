#include "navigation/frame_queue.hpp"

#include <utility>

namespace traverse::inertial {

void FrameQueue::before_append(const FixedLagSmoother& smoother) {
  const bool may_leave = output_ == WindowOutput::kOldest && smoother.is_full();
  if (may_leave) keep_covariances(smoother);
}

void FrameQueue::keep_covariances(const FixedLagSmoother& smoother) {
  if (waiting_.size() != smoother.size()) return;
  const std::vector<NavState::Matrix> covariances = smoother.covariances();
  for (std::size_t k = 0; k < waiting_.size(); ++k) waiting_[k].covariance = covariances[k];
}

void FrameQueue::begin(std::size_t states) {
  complete(output_ == WindowOutput::kNewest ? 0 : states - 1);
  waiting_.emplace_back();
}

void FrameQueue::take(const FixedLagSmoother::Solution& solution,
                      const FixedLagSmoother& smoother) {
  complete(smoother.size());  // the smoother may have begun again
  NavFrame& frame = newest();
  frame.covariance = solution.covariance;
  frame.converged = solution.converged;
  frame.iterations += solution.iterations;
  frame.states = static_cast<int>(smoother.size());
  const std::size_t first = smoother.size() - waiting_.size();
  for (std::size_t k = 0; k < waiting_.size(); ++k) waiting_[k].state = smoother.state(first + k);
}

void FrameQueue::end(const FixedLagSmoother& smoother) {
  if (output_ == WindowOutput::kOldest) keep_covariances(smoother);
  complete(0);
}

/// All but the newest `kept` frames.
void FrameQueue::complete(std::size_t kept) {
  while (waiting_.size() > kept) {
    if (waiting_.front().states > 0) done_.push_back(std::move(waiting_.front()));
    waiting_.pop_front();
  }
}

std::vector<NavFrame> FrameQueue::take_done() { return std::exchange(done_, {}); }

}  // namespace traverse::inertial
