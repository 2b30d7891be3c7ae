#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "traverse/dataset/source.hpp"

#include "recording/reorder_window.hpp"

namespace traverse::dataset {

/// Looks at the stamps of a recording that is read from front to back, as its records arrive.
///
/// A record that does not go on where its sensor was waits until others of that sensor tell whether
/// it is a wrong one, which costs this record alone, or the clock was set. After a clock was set
/// back the stamps of all sensors go on where they were; after a pause or a step forward they stay.
/// At most kMostWaiting records of a sensor wait. Small; copied into bookmarks.
class ArrivalWatch {
 public:
  static constexpr std::size_t kMostWaiting = 6;
  static constexpr std::size_t kEnough = 3;  ///< records that belong together tell of a step

  using Entry = ReorderWindow::Entry;
  struct Rejected {
    const char* fault;
    std::string place;
  };

  /// Takes a record as recorded.
  void push(Entry entry);
  /// At the end of the recording: nothing waits any longer.
  void finish();

  /// What was decided since the last call: records that go on, with the stamps they are to have;
  /// records that do not; steps of the clock.
  std::vector<Entry> take_accepted() { return std::exchange(accepted_, {}); }
  std::vector<Rejected> take_rejected() { return std::exchange(rejected_, {}); }
  std::vector<Fact> take_steps() { return std::exchange(steps_, {}); }

 private:
  struct Track {
    std::optional<geometry::Stamp> last;    ///< moved
    std::optional<geometry::Stamp> before;  ///< the one before that
    geometry::Stamp last_recorded;
    std::array<double, 5> intervals_s{};  ///< the last ones, in any order
    std::size_t intervals = 0;
    double moved_s = 0;
    std::vector<Entry> waiting;  ///< as recorded

    double usual_interval_s() const;
    double longest_step_s() const;
  };

  bool fits(const Track& track, geometry::Stamp stamp) const;
  /// Whether one of the steps known makes `recorded` go on where its sensor was.
  std::optional<double> fitting_move(const Track& track, geometry::Stamp recorded) const;
  void accept(Track& track, Entry entry, double moved_s);
  void accept_before(Track& track, geometry::Stamp stamp, double moved_s);
  void reject_waiting(Track& track);
  bool is_near_clock(const Track& track) const;
  void begin(Track& track, geometry::Stamp stamp, double near_s, double moved_s);
  void begin_alone(Track& track);
  void settle(const std::string& sensor, Track& track);

  std::map<std::string, Track> tracks_;
  std::optional<geometry::Stamp> clock_;  ///< of what was accepted last, of any sensor
  std::uint64_t arrivals_ = 0;
  double moved_s_ = 0;  ///< what the last step back moves stamps by
  std::vector<Entry> accepted_;
  std::vector<Rejected> rejected_;
  std::vector<Fact> steps_;
};

}  // namespace traverse::dataset
