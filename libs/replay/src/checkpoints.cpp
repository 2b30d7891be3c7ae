#include "traverse/replay/checkpoints.hpp"

#include <iterator>
#include <limits>
#include <utility>

namespace traverse::replay {

State::State(const State& other)
    : next_frame(other.next_frame),
      estimator(other.estimator->clone()),
      waiting(other.waiting),
      ready(other.ready),
      finished(other.finished) {}

std::vector<std::size_t> Checkpoints::frames() const {
  std::vector<std::size_t> frames;
  for (const auto& [frame, checkpoint] : by_frame_) frames.push_back(frame);
  return frames;
}

void Checkpoints::add(Checkpoint checkpoint) {
  const std::size_t frame = checkpoint.state.next_frame;
  by_frame_.insert_or_assign(frame, std::move(checkpoint));
  if (by_frame_.size() > kMost) drop_one(frame);
}

const Checkpoint* Checkpoints::before(std::size_t frame) const {
  const auto after = by_frame_.upper_bound(frame);
  return after == by_frame_.begin() ? nullptr : &std::prev(after)->second;
}

/// Drops the one whose absence costs least: the gap it leaves, against its distance.
void Checkpoints::drop_one(std::size_t present_frame) {
  auto cheapest = by_frame_.end();
  double least = std::numeric_limits<double>::infinity();
  for (auto it = std::next(by_frame_.begin()); it != by_frame_.end(); ++it) {
    const auto next = std::next(it);
    if (next == by_frame_.end() || it->first == present_frame) continue;
    const auto gap = static_cast<double>(next->first - std::prev(it)->first);
    const auto distance = static_cast<double>(
        it->first < present_frame ? present_frame - it->first : it->first - present_frame);
    const double cost = gap / (1 + distance);
    if (cost < least) {
      least = cost;
      cheapest = it;
    }
  }
  if (cheapest != by_frame_.end()) by_frame_.erase(cheapest);
}

}  // namespace traverse::replay
