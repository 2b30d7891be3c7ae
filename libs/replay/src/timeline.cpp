#include "traverse/replay/timeline.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "traverse/files/numbers.hpp"

namespace traverse::replay {

using geometry::Stamp;

void Timeline::add(Stamp stamp) {
  if (stamps_.size() == most_) return;
  if (stamps_.empty() || stamps_.back() < stamp) stamps_.push_back(stamp);
  if (stamps_.size() == most_) complete_ = true;
}

void Timeline::confirm(std::size_t frame, Stamp stamp) {
  const auto at = stamps_.begin() + static_cast<std::ptrdiff_t>(std::min(frame, stamps_.size()));
  const auto there = std::lower_bound(at, stamps_.end(), stamp);
  const auto next = stamps_.erase(at, there);
  if (next == stamps_.end() || *next != stamp) stamps_.insert(next, stamp);
}

void Timeline::confirm_end(std::size_t frames) {
  if (frames < stamps_.size()) stamps_.resize(frames);
  complete_ = true;
}

std::size_t Timeline::frame_at(Stamp stamp) const {
  const auto later = std::upper_bound(stamps_.begin(), stamps_.end(), stamp);
  return later == stamps_.begin() ? 0 : static_cast<std::size_t>(later - stamps_.begin()) - 1;
}

double Timeline::seconds_to(std::size_t frame) const {
  return geometry::seconds_between(stamps_.at(0), stamps_.at(frame));
}

namespace {

/// "12.5s", "1:02.5", "1:00:02" as seconds.
std::optional<double> parse_duration(std::string_view text) {
  const bool has_unit = text.ends_with('s');
  if (has_unit) text.remove_suffix(1);
  if (!has_unit && text.find(':') == std::string_view::npos) return std::nullopt;
  double seconds = 0;
  for (;;) {
    const std::size_t colon = text.find(':');
    const auto part = files::parse_double(text.substr(0, colon));
    if (!part || *part < 0 || !std::isfinite(*part)) return std::nullopt;
    seconds = 60 * seconds + *part;
    if (colon == std::string_view::npos) return seconds;
    text.remove_prefix(colon + 1);
  }
}

}  // namespace

std::optional<std::size_t> parse_place(const std::string& text, const Timeline& timeline) {
  if (timeline.size() == 0) return std::nullopt;
  const auto at_stamp = [&](Stamp stamp) { return timeline.frame_at(stamp); };
  if (const auto duration = parse_duration(text)) {
    return at_stamp(geometry::shifted(timeline.stamp(0), *duration));
  }
  const auto number = files::parse_double(text);
  if (!number || *number < 0) return std::nullopt;
  const bool is_whole = text.find_first_not_of("0123456789") == std::string::npos;
  const bool is_stamp = *number >= timeline.stamp(0).seconds() - 1 && *number >= 1e6;
  if (is_stamp || !is_whole) {
    const auto stamp = geometry::parse_stamp_seconds(text);
    // Half a microsecond of grace: a stamp written with fewer digits still means its frame.
    return stamp ? std::optional(at_stamp(geometry::shifted(*stamp, 5e-7))) : std::nullopt;
  }
  return std::min(static_cast<std::size_t>(*number), timeline.size() - 1);
}

bool is_place_known(const std::string& text, const Timeline& timeline) {
  if (timeline.complete()) return true;
  const auto frame = parse_place(text, timeline);
  return frame && *frame + 1 < timeline.size();
}

}  // namespace traverse::replay
