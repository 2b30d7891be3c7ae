#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "traverse/geometry/stamp.hpp"

namespace traverse::replay {

/// The stamps of a recording's frames as far as they are known: an index tells them ahead, the
/// frames themselves have the last word.
class Timeline {
 public:
  std::size_t size() const { return stamps_.size(); }
  geometry::Stamp stamp(std::size_t frame) const { return stamps_.at(frame); }
  const std::vector<geometry::Stamp>& stamps() const { return stamps_; }

  /// Whether all frames are known.
  bool complete() const { return complete_; }
  void set_complete() { complete_ = true; }

  /// No more than so many frames are wanted; with that many the timeline is complete.
  void limit(std::size_t frames) { most_ = frames; }

  /// Appends a frame of the index; ignored unless it is later than all there are.
  void add(geometry::Stamp stamp);

  /// Frame `frame` was read and has this stamp: frames of the index before it that were not there
  /// when read are dropped.
  void confirm(std::size_t frame, geometry::Stamp stamp);
  /// There are `frames` frames and no more.
  void confirm_end(std::size_t frames);

  /// The last frame at or before `stamp`; 0 if there is none.
  std::size_t frame_at(geometry::Stamp stamp) const;

  /// From the first frame, seconds.
  double seconds_to(std::size_t frame) const;

 private:
  std::vector<geometry::Stamp> stamps_;
  std::size_t most_ = std::numeric_limits<std::size_t>::max();
  bool complete_ = false;
};

/// What a person types to name a frame of `timeline`: "120" (a frame), "12.5s" or "1:02.5" (time
/// from the start), or a stamp of the recording's clock, in seconds. \returns nothing if it is none
/// of these
std::optional<std::size_t> parse_place(const std::string& text, const Timeline& timeline);

/// Whether what the text names will not change when more frames become known: it lies before the
/// last one, or all are known.
bool is_place_known(const std::string& text, const Timeline& timeline);

}  // namespace traverse::replay
