#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "traverse/dataset/source.hpp"
#include "traverse/geometry/stamp.hpp"

namespace traverse::dataset {

/// Longer than recordings pause: a stamp that is further ahead is a wrong one, or time has passed
/// or the clock was set.
inline constexpr double kLongestPause_s = 60;
/// Steps back that are smaller are records out of order, not a clock that was set.
inline constexpr double kShortestStepBack_s = 0.25;

/// The stamp of a record, or why it has none to be used.
struct RecordStamp {
  std::optional<geometry::Stamp> stamp;
  const char* fault = nullptr;  ///< "stamp not later than the one before"; null with a stamp
};

/// From a record on the clock tells another time than before.
struct ClockStep {
  std::size_t record = 0;  ///< the first after the step
  geometry::Stamp before;  ///< of the record before it, as recorded
  geometry::Stamp after;   ///< of the first after it, as recorded
  double moved_s = 0;      ///< added to the stamps from there on: of a clock that was set back

  double jump_s() const { return geometry::seconds_between(before, after); }
  bool is_back() const { return jump_s() < 0; }
};

/// The stamps of one sensor in the order of its records.
///
/// A stamp that does not fit those before and after it costs its own record: as many records are
/// kept as have growing stamps. A pause, or a clock that is set back, is kept as a step where at
/// least four records follow it. After a step back the stamps go on where they were, an interval
/// later; after a step forward they stay.
struct StampSequence {
  static constexpr const char* kNotLater = "stamp not later than the one before";
  static constexpr const char* kAhead = "stamp ahead of those that follow";
  static constexpr const char* kAlone = "stamp far from all others";
  static constexpr const char* kNone = "no stamp";

  std::vector<RecordStamp> records;  ///< as many as were given
  std::vector<ClockStep> steps;
  double usual_interval_s = 0;  ///< the median; 0 with fewer than two stamps

  /// \param stamps as recorded; nothing where a record has none
  static StampSequence of(std::span<const std::optional<geometry::Stamp>> stamps);

  /// Moves the records as the steps say. To be called once, when `steps` are settled.
  void apply_steps();
};

/// The stamps of one sensor and what it is called.
struct SensorStamps {
  std::string sensor;  ///< "scans"
  StampSequence sequence;
  std::function<std::string(std::size_t record)> place_of;  ///< "times.txt, stamp 13"
};

/// Says each step in `facts` and moves the stamps. Sensors that a recording stamps by one clock
/// move by the same where it was set back: by what the one with the shortest interval shows, which
/// tells it best.
void settle_steps(std::span<SensorStamps> sensors, std::vector<Fact>& facts);

/// "clock set back" or "a pause, or clock set forward", by how much, where, what follows from it.
Fact fact_of(const ClockStep& step, const std::string& sensor, const std::string& place);

}  // namespace traverse::dataset
