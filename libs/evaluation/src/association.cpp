#include "traverse/evaluation/association.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "traverse/evaluation/evaluation_error.hpp"

#include "names.hpp"

namespace traverse::evaluation {

using geometry::Stamp;
using geometry::Trajectory;

namespace {

/// Nanoseconds of a stamp with an offset, and differences of two of them, always fit.
using Nanoseconds = __int128;

constexpr double kLongestSeconds = 9.2e9;  // what a Stamp holds

Nanoseconds to_nanoseconds(double seconds) { return std::llround(seconds * 1e9); }
double to_seconds(Nanoseconds value) { return static_cast<double>(value) * 1e-9; }
Nanoseconds magnitude(Nanoseconds value) { return value < 0 ? -value : value; }

std::vector<Nanoseconds> times_of(const Trajectory& trajectory, Nanoseconds offset) {
  std::vector<Nanoseconds> times;
  times.reserve(trajectory.size());
  for (const Stamp stamp : trajectory.stamps()) times.push_back(stamp.nanoseconds + offset);
  return times;
}

/// The index of the time nearest to `time`, the first of several.
std::size_t nearest(const std::vector<Nanoseconds>& times, Nanoseconds time) {
  const auto after = std::lower_bound(times.begin(), times.end(), time);
  if (after == times.begin()) return 0;
  const Nanoseconds before = *std::prev(after);
  const bool take_after = after != times.end() && *after - time < time - before;
  const auto found = take_after ? after : std::lower_bound(times.begin(), after, before);
  return static_cast<std::size_t>(found - times.begin());
}

std::string span_text(const Trajectory& trajectory) {
  return fmt::format("{} to {} s", to_text(trajectory.stamps().front()),
                     to_text(trajectory.stamps().back()));
}

void require_usable(const AssociationOptions& options) {
  if (!(options.max_time_difference_s >= 0 && options.max_time_difference_s < kLongestSeconds)) {
    throw std::invalid_argument("the longest time difference must be zero or more seconds");
  }
  if (!(std::abs(options.time_offset_s) < kLongestSeconds)) {
    throw std::invalid_argument("the time offset must be a finite number of seconds");
  }
}

void require_ordered(const Trajectory& trajectory, const char* which) {
  const auto& stamps = trajectory.stamps();
  const auto backward = std::is_sorted_until(stamps.begin(), stamps.end());
  if (backward == stamps.end()) return;
  throw EvaluationError(fmt::format("the stamps of the {} go back at pose {}: {} s after {} s",
                                    which, backward - stamps.begin(), to_text(*backward),
                                    to_text(*std::prev(backward))));
}

void associate_by_index(const Trajectory& estimate, const Trajectory& reference,
                        Association& association) {
  if (estimate.size() != reference.size()) {
    throw EvaluationError(fmt::format(
        "trajectories without stamps are matched by index and must have as many poses: the "
        "estimate has {}, the reference {}",
        estimate.size(), reference.size()));
  }
  if (association.options.time_offset_s != 0) {
    throw EvaluationError("a time offset needs trajectories with stamps");
  }
  association.mode = AssociationMode::kIndex;
  for (std::size_t i = 0; i < estimate.size(); ++i) association.matches.push_back({i, i, 0});
}

void associate_by_stamp(const Trajectory& estimate, const Trajectory& reference,
                        Association& association) {
  const Nanoseconds offset = to_nanoseconds(association.options.time_offset_s);
  const Nanoseconds limit = to_nanoseconds(association.options.max_time_difference_s);
  const auto estimate_times = times_of(estimate, offset);
  const auto reference_times = times_of(reference, 0);
  const bool estimate_drives = estimate.size() <= reference.size();

  Nanoseconds closest = std::numeric_limits<Nanoseconds>::max();
  for (std::size_t k = 0; k < std::min(estimate.size(), reference.size()); ++k) {
    Match match;
    match.estimate = estimate_drives ? k : nearest(estimate_times, reference_times[k]);
    match.reference = estimate_drives ? nearest(reference_times, estimate_times[k]) : k;
    const Nanoseconds difference =
        estimate_times[match.estimate] - reference_times[match.reference];
    match.time_difference_s = to_seconds(difference);
    closest = std::min(closest, magnitude(difference));
    if (magnitude(difference) <= limit) association.matches.push_back(match);
  }
  if (association.matches.empty()) {
    throw EvaluationError(fmt::format(
        "no pose of the estimate is within {} s of a pose of the reference: the estimate spans {}"
        "{}, the reference {}, the closest two are {} s apart",
        association.options.max_time_difference_s, span_text(estimate),
        association.options.time_offset_s == 0
            ? ""
            : fmt::format(" (before the offset of {} s)", association.options.time_offset_s),
        span_text(reference), to_seconds(closest)));
  }
}

}  // namespace

std::string_view name_of(AssociationMode mode) { return name_in(kAssociationNames, mode); }

double Association::largest_time_difference_s() const {
  double largest = 0;
  for (const Match& match : matches) {
    largest = std::max(largest, std::abs(match.time_difference_s));
  }
  return largest;
}

Association associate(const Trajectory& estimate, const Trajectory& reference,
                      const AssociationOptions& options) {
  require_usable(options);
  if (estimate.empty() || reference.empty()) {
    throw EvaluationError(
        fmt::format("the {} has no pose", estimate.empty() ? "estimate" : "reference"));
  }
  if (estimate.is_stamped() != reference.is_stamped()) {
    throw EvaluationError(
        fmt::format("the {} has stamps and the {} has none: poses can be matched by stamp or by "
                    "index, not by both",
                    estimate.is_stamped() ? "estimate" : "reference",
                    estimate.is_stamped() ? "reference" : "estimate"));
  }
  Association association;
  association.options = options;
  if (!estimate.is_stamped()) {
    associate_by_index(estimate, reference, association);
  } else {
    require_ordered(estimate, "estimate");
    require_ordered(reference, "reference");
    associate_by_stamp(estimate, reference, association);
  }
  return association;
}

MatchedPoses matched_poses(const Trajectory& estimate, const Trajectory& reference,
                           const Association& association) {
  MatchedPoses poses;
  for (const Match& match : association.matches) {
    poses.estimate.push_back(estimate.pose(match.estimate));
    poses.reference.push_back(reference.pose(match.reference));
  }
  return poses;
}

}  // namespace traverse::evaluation
