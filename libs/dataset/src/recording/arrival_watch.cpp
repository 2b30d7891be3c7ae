#include "recording/arrival_watch.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>
#include <variant>

#include "recording/stamp_sequence.hpp"

namespace traverse::dataset {

using geometry::seconds_between;
using geometry::Stamp;
using sensors::Measurement;

namespace {

constexpr double kNear_s = 1;  // by which records that arrive together may be stamped apart

/// A scan is shared and does not change: a copy gets the stamp.
Measurement with_stamp(const Measurement& measurement, Stamp stamp) {
  return std::visit(
      [&](const auto& value) -> Measurement {
        if constexpr (requires { value.stamp; }) {
          auto moved = value;
          moved.stamp = stamp;
          return moved;
        } else {
          auto moved = *value;
          moved.stamp = stamp;
          return std::make_shared<const decltype(moved)>(std::move(moved));
        }
      },
      measurement);
}

Stamp stamp_in(const ReorderWindow::Entry& entry) { return sensors::stamp_of(entry.measurement); }

/// Of a sensor with that interval.
double longest_pause_s(double interval_s) {
  constexpr double kIntervals = 20;
  return std::max(kLongestPause_s, kIntervals * interval_s);
}

/// Whether the last `count` of them belong together: each a little later than the one before.
bool belong_together(const std::vector<ReorderWindow::Entry>& entries, std::size_t count,
                     double pause_s) {
  if (entries.size() < count) return false;
  for (std::size_t i = entries.size() - count + 1; i < entries.size(); ++i) {
    const double interval = seconds_between(stamp_in(entries[i - 1]), stamp_in(entries[i]));
    if (!(interval > 0 && interval <= pause_s)) return false;
  }
  return true;
}

}  // namespace

double ArrivalWatch::Track::usual_interval_s() const {
  auto sorted = intervals_s;
  const std::size_t known = std::min(intervals, sorted.size());
  if (known == 0) return 0;
  const auto end = sorted.begin() + static_cast<std::ptrdiff_t>(known);
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((known - 1) / 2);
  std::nth_element(sorted.begin(), middle, end);
  return *middle;
}

double ArrivalWatch::Track::longest_step_s() const {
  constexpr double kIntervals = 10;
  return std::max(kNear_s, kIntervals * usual_interval_s());
}

bool ArrivalWatch::fits(const Track& track, Stamp stamp) const {
  const double ahead_s = seconds_between(*track.last, stamp);
  if (ahead_s > 0) {
    const bool is_with_others = clock_ && std::abs(seconds_between(*clock_, stamp)) <= kNear_s;
    return ahead_s <= track.longest_step_s() || is_with_others;
  }
  // A little late: the reorder window knows what to do. Much: perhaps the last one was ahead.
  if (ahead_s > -ReorderWindow::kSpan) return true;
  return track.before && *track.before < stamp &&
         seconds_between(*track.before, stamp) <= track.longest_step_s();
}

std::optional<double> ArrivalWatch::fitting_move(const Track& track, Stamp recorded) const {
  // A step that others have shown holds for a sensor too slow to show it itself.
  if (track.moved_s != moved_s_ && clock_) {
    const auto apart_s = [&](double moved_s) {
      return std::abs(seconds_between(*clock_, geometry::shifted(recorded, moved_s)));
    };
    const bool is_nearer = apart_s(moved_s_) < apart_s(track.moved_s);
    if (is_nearer && fits(track, geometry::shifted(recorded, moved_s_))) return moved_s_;
  }
  for (const double moved_s : {track.moved_s, 0.0}) {
    if (fits(track, geometry::shifted(recorded, moved_s))) return moved_s;
  }
  return std::nullopt;
}

void ArrivalWatch::accept(Track& track, Entry entry, double moved_s) {
  const Stamp recorded = stamp_in(entry);
  const Stamp stamp = geometry::shifted(recorded, moved_s);
  if (track.last) {
    const double interval = seconds_between(*track.last, stamp);
    if (interval > 0) track.intervals_s.at(track.intervals++ % 5) = interval;
    // One that steps back behind the last one says that the last one was ahead.
    if (interval > 0) track.before = track.last;
  }
  track.last = stamp;
  track.last_recorded = recorded;
  track.moved_s = moved_s;
  clock_ = stamp;
  if (moved_s != 0) entry.measurement = with_stamp(entry.measurement, stamp);
  accepted_.push_back(std::move(entry));
}

/// What waited because it came after a pause is in order if it is before one that fits.
void ArrivalWatch::accept_before(Track& track, Stamp stamp, double moved_s) {
  std::vector<Entry> others;
  for (Entry& entry : std::exchange(track.waiting, {})) {
    const Stamp moved = geometry::shifted(stamp_in(entry), moved_s);
    if (*track.last < moved && moved < stamp) {
      accept(track, std::move(entry), moved_s);
    } else {
      others.push_back(std::move(entry));
    }
  }
  track.waiting = std::move(others);
}

void ArrivalWatch::reject_waiting(Track& track) {
  for (Entry& entry : track.waiting) {
    const bool is_ahead = track.last && stamp_in(entry) > track.last_recorded;
    rejected_.push_back(
        {is_ahead ? StampSequence::kAhead : StampSequence::kNotLater, std::move(entry.place)});
  }
  track.waiting.clear();
}

/// Of the first records of a sensor those that are near `stamp` go on.
void ArrivalWatch::begin(Track& track, Stamp stamp, double near_s, double moved_s) {
  for (Entry& entry : std::exchange(track.waiting, {})) {
    const Stamp moved = geometry::shifted(stamp_in(entry), moved_s);
    if (std::abs(seconds_between(stamp, moved)) <= near_s) {
      accept(track, std::move(entry), moved_s);
    } else {
      rejected_.push_back({StampSequence::kAlone, std::move(entry.place)});
    }
  }
}

/// A sensor whose clock no other shares begins with those that most of its first records are near.
void ArrivalWatch::begin_alone(Track& track) {
  std::vector<Stamp> stamps;
  for (const Entry& entry : track.waiting) stamps.push_back(stamp_in(entry));
  std::sort(stamps.begin(), stamps.end());
  double interval_s = std::numeric_limits<double>::infinity();  // with two nobody can tell
  if (stamps.size() >= kEnough) {
    std::vector<double> intervals;
    for (std::size_t i = 1; i < stamps.size(); ++i) {
      intervals.push_back(seconds_between(stamps[i - 1], stamps[i]));
    }
    std::sort(intervals.begin(), intervals.end());
    interval_s = intervals[(intervals.size() - 1) / 2];
  }
  begin(track, stamps[(stamps.size() - 1) / 2], longest_pause_s(interval_s), 0);
  if (!clock_) return;
  for (auto& [sensor, other] : tracks_) {
    if (!other.last && is_near_clock(other)) begin(other, *clock_, kLongestPause_s, 0);
  }
}

bool ArrivalWatch::is_near_clock(const Track& track) const {
  return clock_ && std::any_of(track.waiting.begin(), track.waiting.end(), [&](const Entry& entry) {
           const Stamp moved = geometry::shifted(stamp_in(entry), moved_s_);
           return std::abs(seconds_between(*clock_, moved)) <= kLongestPause_s;
         });
}

/// The last records that wait belong together: the clock was set, or time has passed.
void ArrivalWatch::settle(const std::string& sensor, Track& track) {
  std::vector<Entry> together(
      std::make_move_iterator(track.waiting.end() - static_cast<std::ptrdiff_t>(kEnough)),
      std::make_move_iterator(track.waiting.end()));
  track.waiting.resize(track.waiting.size() - kEnough);
  reject_waiting(track);
  const Stamp first = stamp_in(together.front());
  ClockStep step{0, track.last_recorded, first, 0};
  double moved_s = track.moved_s;
  const double ahead_s = seconds_between(*track.last, geometry::shifted(first, moved_s));
  if (ahead_s < 0) {
    step.moved_s = track.usual_interval_s() - ahead_s;
    moved_s += step.moved_s;
    moved_s_ = moved_s;
  }
  if (ahead_s < 0 || ahead_s > longest_pause_s(track.usual_interval_s())) {
    steps_.push_back(fact_of(step, sensor, together.front().place));
  }
  for (Entry& entry : together) accept(track, std::move(entry), moved_s);
}

void ArrivalWatch::push(Entry entry) {
  entry.arrival = arrivals_++;
  const std::string sensor = sensors::sensor_of(entry.measurement);
  Track& track = tracks_[sensor];
  const Stamp recorded = stamp_in(entry);
  if (!track.last) {
    track.waiting.push_back(std::move(entry));
    if (is_near_clock(track)) {
      begin(track, *clock_, kLongestPause_s, moved_s_);
    } else if (track.waiting.size() >= kEnough) {
      begin_alone(track);
    }
    return;
  }
  if (const auto moved_s = fitting_move(track, recorded)) {
    accept_before(track, geometry::shifted(recorded, *moved_s), *moved_s);
    reject_waiting(track);
    accept(track, std::move(entry), *moved_s);
    return;
  }
  track.waiting.push_back(std::move(entry));
  if (belong_together(track.waiting, kEnough, longest_pause_s(track.usual_interval_s()))) {
    settle(sensor, track);
  } else if (track.waiting.size() > kMostWaiting) {
    rejected_.push_back({StampSequence::kAlone, std::move(track.waiting.front().place)});
    track.waiting.erase(track.waiting.begin());
  }
}

void ArrivalWatch::finish() {
  for (auto& [sensor, track] : tracks_) {
    if (track.waiting.empty()) continue;
    if (!track.last) {
      begin_alone(track);
    } else {
      for (Entry& entry : std::exchange(track.waiting, {})) {
        rejected_.push_back({StampSequence::kAlone, std::move(entry.place)});
      }
    }
  }
}

}  // namespace traverse::dataset
