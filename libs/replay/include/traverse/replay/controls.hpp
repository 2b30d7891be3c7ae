#pragma once

#include <cstddef>
#include <optional>

#include "traverse/replay/timeline.hpp"

namespace traverse::replay {

/// Which frame should be shown at a moment: play, pause, seek, speed, loop and range, as a state
/// machine without a clock of its own. Frames are counted from 0.
///
/// Playing takes its pace from the stamps. When the estimator cannot keep up, the pace is the
/// estimator's: no frame is left out, and nothing is caught up later.
class Controls {
 public:
  static constexpr double kSlowest = 0.1;  ///< times real time
  static constexpr double kFastest = 16;
  /// A longer gap between stamps is passed in this time, seconds of the recording.
  static constexpr double kLongestWait = 1;

  void play();
  void pause() { playing_ = false; }
  void toggle() { playing_ ? pause() : play(); }
  bool playing() const { return playing_; }

  /// Asks for a frame; beyond the frames there are: for the nearest. Does not end playing.
  void seek(std::size_t frame);
  void step(std::ptrdiff_t frames);  ///< pauses
  void home();                       ///< of the range
  void end();

  void set_speed(double times_real_time);  ///< clamped
  void faster() { set_speed(speed_ * 2); }
  void slower() { set_speed(speed_ / 2); }
  double speed() const { return speed_; }
  void set_unlimited(bool unlimited) { unlimited_ = unlimited; }  ///< as fast as possible
  bool unlimited() const { return unlimited_; }

  void set_loop(bool loop) { loop_ = loop; }
  bool loop() const { return loop_; }

  /// Playing stays within these frames, both included; seeking does not.
  void set_range(std::optional<std::size_t> first, std::optional<std::size_t> last);
  std::optional<std::size_t> range_first() const { return range_first_; }
  std::optional<std::size_t> range_last() const { return range_last_; }

  /// The first frame that can be shown: where the estimator was started.
  void set_origin(std::size_t frame);
  std::size_t origin() const { return origin_; }

  /// The frame that is asked for, among those there are.
  std::size_t wanted_in(const Timeline& timeline) const;

  /// Whether nothing moves any more: paused, with the frame that is asked for on show.
  bool is_settled(std::size_t shown, const Timeline& timeline) const;

  /// Lets `seconds` of wall time pass. \param shown the frame on show  \returns wanted_in()
  std::size_t advance(double seconds, std::size_t shown, const Timeline& timeline);

 private:
  std::size_t first() const;
  std::size_t last(const Timeline& timeline) const;
  void pass(double seconds, std::size_t shown, const Timeline& timeline);

  bool playing_ = false;
  bool unlimited_ = false;
  bool loop_ = false;
  double speed_ = 1;
  std::size_t origin_ = 0;
  std::size_t wanted_ = 0;
  double credit_s_ = 0;  // of the recording's time, not yet spent on a frame
  std::optional<std::size_t> range_first_;
  std::optional<std::size_t> range_last_;
};

}  // namespace traverse::replay
