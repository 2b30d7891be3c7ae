#pragma once

#include <optional>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"

#include "recording/arrival_watch.hpp"
#include "recording/reorder_window.hpp"
#include "recording/stamp_order.hpp"

namespace traverse::dataset {

/// Measurements of a recording that is read from front to back, between the file and who reads:
/// they come out in the order of their stamps, those of a sensor with stamps that grow, and what
/// cannot is counted. Copied into bookmarks.
class ArrivalQueue {
 public:
  /// Whether steps of the clock are looked for, or have been taken out before.
  enum class Clock { kWatched, kSteady };

  explicit ArrivalQueue(Clock clock = Clock::kWatched) : clock_(clock) {}

  /// \param place where the record stands, for messages
  void push(sensors::Measurement measurement, const std::string& place);
  /// The recording is over: nothing waits any longer.
  void finish();
  bool is_finished() const { return is_finished_; }
  /// Forgets what waits.
  void drop_waiting();

  /// The next measurement; nothing when the recording is over. \param read_on reads the next record
  /// and pushes what it gives, or finishes
  template <typename ReadOn>
  std::optional<sensors::Measurement> next(const ReadOn& read_on) {
    for (;;) {
      if (auto measurement = pop()) return measurement;
      if (is_finished_) return std::nullopt;
      read_on();
    }
  }

  /// What could not be used; readers add to it.
  SkippedRecords& skipped() { return skipped_; }
  const SkippedRecords& skipped() const { return skipped_; }

  /// Adds the steps of the clock that were found to `facts`, each once.
  void note_steps(std::vector<Fact>& facts);

 private:
  void take_decided();
  std::optional<sensors::Measurement> pop();

  Clock clock_;
  ArrivalWatch watch_;
  ReorderWindow window_;
  StampOrder order_;
  SkippedRecords skipped_;
  bool is_finished_ = false;
};

}  // namespace traverse::dataset
