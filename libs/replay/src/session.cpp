#include "traverse/replay/session.hpp"

#include <algorithm>
#include <utility>

#include "frame_sensor.hpp"

namespace traverse::replay {

using sensors::Measurement;

namespace {

constexpr std::size_t kCheckpointEvery = 10;  // frames, while nothing else asks for one

bool is_power_of_two(std::size_t n) { return n != 0 && (n & (n - 1)) == 0; }

/// The scan stamped like the frame; earlier ones will not be asked for again.
std::optional<Measurement> take(std::deque<Measurement>& waiting, geometry::Stamp stamp) {
  while (!waiting.empty() && sensors::stamp_of(waiting.front()) < stamp) waiting.pop_front();
  if (waiting.empty() || sensors::stamp_of(waiting.front()) != stamp) return std::nullopt;
  std::optional<Measurement> scan = std::move(waiting.front());
  waiting.pop_front();
  return scan;
}

}  // namespace

Session::Session(std::unique_ptr<dataset::Source> source,
                 std::unique_ptr<pipeline::Estimator> estimator, std::string frame_sensor,
                 std::size_t origin)
    : source_(std::move(source)), frame_sensor_(std::move(frame_sensor)) {
  restart(std::move(estimator), origin);
}

void Session::restart(std::unique_ptr<pipeline::Estimator> estimator, std::size_t origin) {
  checkpoints_.clear();
  frame_.reset();
  state_ = {};
  state_.estimator = std::move(estimator);
  state_.next_frame = origin;
  origin_ = origin;
  go_to_origin();
  keep_checkpoint();
}

/// Reads the recording up to just behind the scan before the origin's.
void Session::go_to_origin() {
  source_->rewind();
  measurements_ = 0;
  for (std::size_t frames = 0; frames < origin_;) {
    const auto measurement = source_->next();
    if (!measurement) return;
    ++measurements_;
    frames += is_frame(*measurement, frame_sensor_) ? 1 : 0;
  }
}

Session::Outcome Session::go_to(std::size_t number,
                                const std::function<bool(const SessionFrame&)>& passed) {
  number = std::max(number, origin_);
  if (frame_ && frame_->number == number) return Outcome::kThere;
  // A state from which the frame is still to come, as near to it as there is one.
  const Checkpoint* near = checkpoints_.before(number);
  if (state_.next_frame > number || near->state.next_frame > state_.next_frame) return_to(*near);
  while (state_.next_frame <= number) {
    if (is_wanted_checkpoint(number)) keep_checkpoint();
    if (!advance()) return Outcome::kEnd;
    if (!passed(*frame_)) {
      return frame_->number == number ? Outcome::kThere : Outcome::kStopped;
    }
  }
  return Outcome::kThere;
}

/// On the way to a frame, checkpoints stand before it at distances 1, 2, 4, 8 ...: whoever went
/// back by one frame will go back by another.
bool Session::is_wanted_checkpoint(std::size_t target) const {
  if (checkpoints_.has(state_.next_frame)) return false;
  return state_.next_frame % kCheckpointEvery == 0 || is_power_of_two(target - state_.next_frame);
}

/// Makes the next frame the present one. \returns false at the end of the recording
bool Session::advance() {
  while (state_.ready.empty()) {
    if (state_.finished) return false;
    const auto measurement = source_->next();
    if (measurement) {
      ++measurements_;
      feed(*measurement);
    } else {
      state_.finished = true;
      for (auto& frame : state_.estimator->finish()) state_.ready.push_back(std::move(frame));
    }
  }
  SessionFrame frame;
  frame.number = state_.next_frame++;
  frame.pose = std::move(state_.ready.front());
  state_.ready.pop_front();
  frame.scan = take(state_.waiting, frame.pose.stamp);
  frame_ = std::move(frame);
  return true;
}

void Session::feed(const Measurement& measurement) {
  if (is_frame(measurement, frame_sensor_)) state_.waiting.push_back(measurement);
  for (auto& frame : state_.estimator->process(measurement)) {
    state_.ready.push_back(std::move(frame));
  }
}

void Session::keep_checkpoint() { checkpoints_.add({state_, source_->bookmark(), measurements_}); }

void Session::return_to(const Checkpoint& checkpoint) {
  state_ = State(checkpoint.state);
  measurements_ = checkpoint.measurements;
  frame_.reset();
  if (checkpoint.place) {
    source_->return_to(*checkpoint.place);
    return;
  }
  source_->rewind();
  for (std::size_t i = 0; i < measurements_; ++i) source_->next();
}

}  // namespace traverse::replay
