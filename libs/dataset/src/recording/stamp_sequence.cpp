#include "recording/stamp_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

namespace traverse::dataset {

using geometry::seconds_between;
using geometry::Stamp;

namespace {

constexpr const char* kBack = "clock set back";
constexpr const char* kForward = "a pause, or clock set forward";

/// Of records: small, because there are many and each has several.
using RecordNumber = std::uint32_t;
constexpr RecordNumber kNobody = static_cast<RecordNumber>(-1);

/// A record with a stamp.
struct Stamped {
  Stamp stamp;
  RecordNumber record;
};

/// The best chain of records that ends at one of them.
struct StampChain {
  std::int32_t worth = 0;
  RecordNumber before = kNobody;  ///< the record before it in the chain
};

/// Tells of ranges of stamps which record ends the best chain, the first of several.
class BestOfRange {
 public:
  BestOfRange(std::size_t stamps, const std::vector<StampChain>& chains)
      : chains_(chains), size_(stamps), best_(2 * stamps, kNobody) {}

  /// `rank` of the record's stamp among all, from 0.
  void add(std::size_t rank, RecordNumber record) {
    for (std::size_t node = rank + size_; node > 0; node /= 2) {
      best_[node] = better(best_[node], record);
    }
  }
  /// Of the ranks from `first` up to `end`, without it.
  RecordNumber find(std::size_t first, std::size_t end) const {
    RecordNumber best = kNobody;
    for (first += size_, end += size_; first < end; first /= 2, end /= 2) {
      if (first % 2 == 1) best = better(best, best_[first++]);
      if (end % 2 == 1) best = better(best, best_[--end]);
    }
    return best;
  }
  RecordNumber better(RecordNumber a, RecordNumber b) const {
    if (a == kNobody || b == kNobody) return std::min(a, b);
    if (chains_[a].worth != chains_[b].worth) return chains_[a].worth > chains_[b].worth ? a : b;
    return std::min(a, b);
  }

 private:
  const std::vector<StampChain>& chains_;
  std::size_t size_;
  std::vector<RecordNumber> best_;
};

double median_interval(const std::vector<Stamped>& records) {
  std::vector<double> intervals;
  for (std::size_t k = 1; k < records.size(); ++k) {
    const double interval = seconds_between(records[k - 1].stamp, records[k].stamp);
    if (interval > 0) intervals.push_back(interval);
  }
  if (intervals.empty()) return 0;
  // The lower one of two: of three records the two that are near each other tell.
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>((intervals.size() - 1) / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

bool is_regular(const std::vector<Stamped>& records, double longest_pause_s) {
  for (std::size_t k = 1; k < records.size(); ++k) {
    const double interval = seconds_between(records[k - 1].stamp, records[k].stamp);
    if (!(interval > 0 && interval <= longest_pause_s)) return false;
  }
  return true;
}

/// The numbers of the records that are kept: of all chains of growing stamps, and of such chains
/// one after the other at the price of three records, the one of most worth.
std::vector<RecordNumber> best_chain(const std::vector<Stamped>& records, double longest_pause_s) {
  constexpr std::int32_t kPriceOfStep = 3;
  std::vector<Stamp> sorted;
  sorted.reserve(records.size());
  for (const Stamped& record : records) sorted.push_back(record.stamp);
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  const auto rank_of = [&](Stamp stamp) {
    return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), stamp) -
                                    sorted.begin());
  };

  std::vector<StampChain> chains(records.size());
  BestOfRange nearby(sorted.size(), chains);
  RecordNumber best = kNobody;  // of all so far
  for (RecordNumber k = 0; k < records.size(); ++k) {
    const Stamp stamp = records[k].stamp;
    const std::size_t rank = rank_of(stamp);
    const RecordNumber before =
        nearby.find(rank_of(geometry::shifted(stamp, -longest_pause_s)), rank);
    chains[k] = {1, kNobody};
    if (before != kNobody) chains[k] = {chains[before].worth + 1, before};
    if (best != kNobody && chains[best].worth + 1 - kPriceOfStep > chains[k].worth) {
      chains[k] = {chains[best].worth + 1 - kPriceOfStep, best};
    }
    nearby.add(rank, k);
    best = nearby.better(best, k);
  }
  std::vector<RecordNumber> kept;
  for (RecordNumber k = best; k != kNobody; k = chains[k].before) kept.push_back(k);
  std::reverse(kept.begin(), kept.end());
  return kept;
}

/// Why a record that lies between two that are kept is not kept itself.
const char* fault_of(Stamp stamp, const std::optional<Stamp>& before,
                     const std::optional<Stamp>& after) {
  if (before && stamp <= *before) return StampSequence::kNotLater;
  if (after && stamp >= *after) return StampSequence::kAhead;
  return StampSequence::kAlone;
}

}  // namespace

StampSequence StampSequence::of(std::span<const std::optional<Stamp>> stamps) {
  constexpr double kLongestPauseIntervals = 20;  // of a sensor that is slow
  StampSequence sequence;
  sequence.records.resize(stamps.size(), {std::nullopt, kNone});
  std::vector<Stamped> records;
  records.reserve(stamps.size());
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (stamps[i]) records.push_back({*stamps[i], static_cast<RecordNumber>(i)});
  }
  sequence.usual_interval_s = median_interval(records);
  const double longest_pause_s =
      std::max(kLongestPause_s, kLongestPauseIntervals * sequence.usual_interval_s);
  if (is_regular(records, longest_pause_s)) {
    for (const Stamped& record : records) sequence.records[record.record] = {record.stamp};
    return sequence;
  }

  const auto stamp_at = [&](const std::vector<RecordNumber>& kept, std::size_t k) {
    return records[kept[k]].stamp;
  };
  std::vector<RecordNumber> kept;
  for (const RecordNumber k : best_chain(records, longest_pause_s)) {
    const double interval =
        kept.empty() ? 1 : seconds_between(records[kept.back()].stamp, records[k].stamp);
    if (interval <= 0 && interval > -kShortestStepBack_s) continue;
    if (!kept.empty() && (interval < 0 || interval > longest_pause_s)) {
      sequence.steps.push_back(
          {records[k].record, records[kept.back()].stamp, records[k].stamp, 0});
    }
    kept.push_back(k);
  }
  for (ClockStep& step : sequence.steps) {
    if (step.is_back()) step.moved_s = sequence.usual_interval_s - step.jump_s();
  }
  std::size_t next = 0;  // of `kept`
  for (std::size_t k = 0; k < records.size(); ++k) {
    RecordStamp& record = sequence.records[records[k].record];
    if (next < kept.size() && kept[next] == k) {
      record = {records[k].stamp};
      ++next;
      continue;
    }
    const auto before = next > 0 ? std::optional(stamp_at(kept, next - 1)) : std::nullopt;
    const auto after = next < kept.size() ? std::optional(stamp_at(kept, next)) : std::nullopt;
    record = {std::nullopt, fault_of(records[k].stamp, before, after)};
  }
  return sequence;
}

void StampSequence::apply_steps() {
  double moved_s = 0;
  std::optional<Stamp> last;
  auto step = steps.begin();
  for (std::size_t i = 0; i < records.size(); ++i) {
    for (; step != steps.end() && step->record <= i; ++step) moved_s += step->moved_s;
    RecordStamp& record = records[i];
    if (!record.stamp) continue;
    record.stamp = geometry::shifted(*record.stamp, moved_s);
    if (last && *record.stamp <= *last) {
      record = {std::nullopt, kNotLater};
    } else {
      last = record.stamp;
    }
  }
}

void settle_steps(std::span<SensorStamps> sensors, std::vector<Fact>& facts) {
  struct StepBack {
    ClockStep* step;
    double interval_s;  // of its sensor
  };
  std::vector<StepBack> steps;
  for (SensorStamps& sensor : sensors) {
    for (ClockStep& step : sensor.sequence.steps) {
      if (step.is_back()) steps.push_back({&step, sensor.sequence.usual_interval_s});
    }
  }
  std::stable_sort(steps.begin(), steps.end(), [](const StepBack& a, const StepBack& b) {
    return a.interval_s < b.interval_s;
  });
  constexpr double kSlack_s = 1;  // by which records of one moment may be stamped apart
  for (std::size_t i = 0; i < steps.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double unsure_s = kSlack_s + 2 * (steps[i].interval_s + steps[k].interval_s);
      const bool is_same =
          std::abs(seconds_between(steps[i].step->before, steps[k].step->before)) < unsure_s &&
          std::abs(steps[i].step->moved_s - steps[k].step->moved_s) < unsure_s;
      if (!is_same) continue;
      steps[i].step->moved_s = steps[k].step->moved_s;
      break;
    }
  }
  for (SensorStamps& sensor : sensors) {
    for (const ClockStep& step : sensor.sequence.steps) {
      facts.push_back(fact_of(step, sensor.sensor, sensor.place_of(step.record)));
    }
    sensor.sequence.apply_steps();
  }
}

bool is_clock_step(const Fact& fact) { return fact.name == kBack || fact.name == kForward; }

Fact fact_of(const ClockStep& step, const std::string& sensor, const std::string& place) {
  const double jump_s = step.jump_s();
  const std::string where = fmt::format("from {} on, stamped {} after {}", place,
                                        to_text(step.after), to_text(step.before));
  if (!step.is_back()) {
    return {kForward, fmt::format("{}: by {:.3f} s, {}: a new segment", sensor, jump_s, where),
            "no stamp in between; the stamps stay as recorded"};
  }
  return {kBack, fmt::format("{}: by {:.3f} s, {}: a new segment", sensor, -jump_s, where),
          fmt::format("its stamps are moved by {:.6f} s so that time goes on; a reference has to "
                      "follow the clock of the first segment",
                      step.moved_s)};
}

}  // namespace traverse::dataset
