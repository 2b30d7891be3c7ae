#include "traverse/replay/controls.hpp"

#include <algorithm>
#include <limits>

namespace traverse::replay {

namespace {

constexpr std::size_t kEnd = std::numeric_limits<std::size_t>::max();

/// How far the wanted frame may be ahead of the one on show: enough for the fastest speed at a slow
/// tick, little enough that pausing takes effect at once.
constexpr std::size_t kMostAhead = 4;

}  // namespace

void Controls::play() {
  playing_ = true;
  credit_s_ = 0;
}

void Controls::seek(std::size_t frame) {
  wanted_ = std::max(frame, origin_);
  credit_s_ = 0;
}

void Controls::step(std::ptrdiff_t frames) {
  pause();
  const auto now = static_cast<std::ptrdiff_t>(wanted_);
  seek(static_cast<std::size_t>(std::max<std::ptrdiff_t>(now + frames, 0)));
}

void Controls::home() { seek(first()); }

void Controls::end() { seek(range_last_.value_or(kEnd)); }

void Controls::set_speed(double times_real_time) {
  speed_ = std::clamp(times_real_time, kSlowest, kFastest);
}

void Controls::set_range(std::optional<std::size_t> first, std::optional<std::size_t> last) {
  if (first && last && *first > *last) std::swap(first, last);
  range_first_ = first;
  range_last_ = last;
}

void Controls::set_origin(std::size_t frame) {
  origin_ = frame;
  seek(std::max(wanted_, frame));
}

std::size_t Controls::first() const { return std::max(range_first_.value_or(0), origin_); }

std::size_t Controls::last(const Timeline& timeline) const {
  const std::size_t there = timeline.size() == 0 ? 0 : timeline.size() - 1;
  return std::max(std::min(range_last_.value_or(kEnd), there), origin_);
}

std::size_t Controls::wanted_in(const Timeline& timeline) const {
  const std::size_t there = timeline.size() == 0 ? 0 : timeline.size() - 1;
  return std::min(wanted_, std::max(there, origin_));
}

bool Controls::is_settled(std::size_t shown, const Timeline& timeline) const {
  const bool waits_for_the_end = wanted_ == kEnd && !timeline.complete();
  return !playing_ && !waits_for_the_end && shown == wanted_in(timeline);
}

std::size_t Controls::advance(double seconds, std::size_t shown, const Timeline& timeline) {
  // "The end" of a recording whose end is not known yet stays asked for until it is.
  if (timeline.complete() || wanted_ != kEnd) wanted_ = wanted_in(timeline);
  if (playing_ && wanted_ != kEnd) pass(seconds, shown, timeline);
  return wanted_in(timeline);
}

void Controls::pass(double seconds, std::size_t shown, const Timeline& timeline) {
  const bool is_seeking = wanted_ < shown || wanted_ > shown + kMostAhead;
  if (is_seeking) return;  // the way there takes its own time
  const std::size_t end = last(timeline);
  if (wanted_ >= end) {
    const bool at_end = timeline.complete() || range_last_ == end;
    if (!at_end || shown < wanted_) return;
    if (loop_) {
      home();
    } else {
      pause();
    }
    return;
  }
  if (wanted_ < first()) return home();
  credit_s_ += seconds * speed_;
  while (wanted_ < end && wanted_ < shown + (unlimited_ ? 1 : kMostAhead)) {
    const double interval =
        std::clamp(geometry::seconds_between(timeline.stamp(wanted_), timeline.stamp(wanted_ + 1)),
                   0.0, kLongestWait);
    if (!unlimited_ && credit_s_ < interval) return;
    credit_s_ -= interval;
    ++wanted_;
  }
  credit_s_ = 0;  // the estimator is behind: what it did not use is not caught up
}

}  // namespace traverse::replay
