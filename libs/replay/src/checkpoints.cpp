#include "traverse/replay/checkpoints.hpp"

#include <iterator>
#include <limits>
#include <utility>
#include <variant>

namespace traverse::replay {

namespace {

constexpr std::size_t kBytesAPoint = 22;  // x, y, z, intensity, time: floats; ring: 16 bits

/// Of the scans, which are large; all else counts as nothing.
std::size_t bytes_of(const sensors::Measurement& measurement) {
  using LidarPtr = std::shared_ptr<const sensors::LidarScan>;
  const auto* scan = std::get_if<LidarPtr>(&measurement);
  return scan == nullptr ? 0 : (*scan)->size() * kBytesAPoint;
}

}  // namespace

State::State(const State& other)
    : next_frame(other.next_frame),
      estimator(other.estimator->clone()),
      waiting(other.waiting),
      ready(other.ready),
      finished(other.finished) {}

std::size_t State::bytes() const {
  std::size_t bytes = estimator ? estimator->bytes() : 0;
  for (const sensors::Measurement& measurement : waiting) bytes += bytes_of(measurement);
  for (const pipeline::PoseFrame& frame : ready) {
    bytes += sizeof(frame) + frame.record.size() * sizeof(double);
  }
  return bytes;
}

void Checkpoints::clear() {
  by_frame_.clear();
  bytes_ = 0;
}

std::vector<std::size_t> Checkpoints::frames() const {
  std::vector<std::size_t> frames;
  for (const auto& [frame, kept] : by_frame_) frames.push_back(frame);
  return frames;
}

void Checkpoints::add(Checkpoint checkpoint) {
  const std::size_t frame = checkpoint.state.next_frame;
  const std::size_t bytes = checkpoint.state.bytes();
  const auto known = by_frame_.find(frame);
  if (known != by_frame_.end()) bytes_ -= known->second.bytes;
  by_frame_.insert_or_assign(frame, Kept{std::move(checkpoint), bytes});
  bytes_ += bytes;
  while (by_frame_.size() > kMost || bytes_ > max_bytes_) {
    if (!drop_one(frame)) break;
  }
}

const Checkpoint* Checkpoints::before(std::size_t frame) const {
  const auto after = by_frame_.upper_bound(frame);
  return after == by_frame_.begin() ? nullptr : &std::prev(after)->second.checkpoint;
}

/// Drops the one whose absence costs least: the gap it leaves, against its distance.
/// \returns false if there is none to drop
bool Checkpoints::drop_one(std::size_t present_frame) {
  auto cheapest = by_frame_.end();
  double least = std::numeric_limits<double>::infinity();
  for (auto it = std::next(by_frame_.begin()); it != by_frame_.end(); ++it) {
    if (it->first == present_frame) continue;
    const auto next = std::next(it);
    // Behind the last one there may be many frames more, all to be estimated again without it.
    const std::size_t end = next == by_frame_.end() ? 2 * it->first : next->first;
    const auto gap = static_cast<double>(end - std::prev(it)->first);
    const auto distance = static_cast<double>(
        it->first < present_frame ? present_frame - it->first : it->first - present_frame);
    const double cost = gap / (1 + distance);
    if (cost < least) {
      least = cost;
      cheapest = it;
    }
  }
  if (cheapest == by_frame_.end()) return false;
  bytes_ -= cheapest->second.bytes;
  by_frame_.erase(cheapest);
  return true;
}

}  // namespace traverse::replay
