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

namespace {

/// Nanoseconds of a stamp with an offset, and differences of two of them, always fit.
using Nanoseconds = __int128;

constexpr double kLongestSeconds = 9.2e9;  // what a Stamp holds

Nanoseconds to_nanoseconds(double seconds) { return std::llround(seconds * 1e9); }
double to_seconds(Nanoseconds value) { return static_cast<double>(value) * 1e-9; }
Nanoseconds magnitude(Nanoseconds value) { return value < 0 ? -value : value; }

/// The stamps of a trajectory as evo has them: doubles of seconds, moved by `offset_s`.
class SecondsOfEvo {
 public:
  SecondsOfEvo(const TrajectoryView& trajectory, double offset_s)
      : trajectory_(trajectory), offset_s_(offset_s) {}

  std::size_t size() const { return trajectory_.size(); }
  double operator[](std::size_t i) const {
    const Stamp stamp = trajectory_.stamps[i];
    const double seconds = trajectory_.times == TimesInFile::kSeconds
                               ? geometry::nearest_seconds(stamp)
                               : static_cast<double>(stamp.nanoseconds) / 1e9;
    return seconds + offset_s_;
  }

 private:
  const TrajectoryView& trajectory_;
  double offset_s_;
};

/// Tells of times that do not go back the index of the nearest stamp of a trajectory, the first of
/// several that the differences of doubles do not tell apart.
class Nearest {
 public:
  explicit Nearest(const SecondsOfEvo& stamps) : stamps_(stamps) {}

  struct Found {
    std::size_t index;
    double difference_s;  ///< a magnitude
  };
  Found operator()(double time) {
    while (after_ < stamps_.size() && stamps_[after_] < time) ++after_;
    const auto difference = [&](std::size_t i) { return std::abs(stamps_[i] - time); };
    if (after_ == 0) return {0, difference(0)};
    const double before = difference(after_ - 1);
    if (after_ < stamps_.size() && difference(after_) < before) return {after_, difference(after_)};
    std::size_t first = after_ - 1;
    if (first > 0 && difference(first - 1) <= before) {
      // Differences shrink towards `first`: bisection, because very many may be equal.
      std::size_t least = 0;
      while (least < first) {
        const std::size_t middle = least + (first - least) / 2;
        if (difference(middle) <= before) {
          first = middle;
        } else {
          least = middle + 1;
        }
      }
    }
    return {first, before};
  }

 private:
  SecondsOfEvo stamps_;
  std::size_t after_ = 0;  ///< the first not before the last time
};

std::string span_text(const TrajectoryView& trajectory) {
  return fmt::format("{} to {} s", to_text(trajectory.stamps.front()),
                     to_text(trajectory.stamps.back()));
}

void require_usable(const AssociationOptions& options) {
  if (!(options.max_time_difference_s >= 0 && options.max_time_difference_s < kLongestSeconds)) {
    throw std::invalid_argument("the longest time difference must be zero or more seconds");
  }
  if (!(std::abs(options.time_offset_s) < kLongestSeconds)) {
    throw std::invalid_argument("the time offset must be a finite number of seconds");
  }
}

void require_ordered(const TrajectoryView& trajectory, const char* which) {
  const auto& stamps = trajectory.stamps;
  const auto backward = std::is_sorted_until(stamps.begin(), stamps.end());
  if (backward == stamps.end()) return;
  throw EvaluationError(fmt::format("the stamps of the {} go back at pose {}: {} s after {} s",
                                    which, backward - stamps.begin(), to_text(*backward),
                                    to_text(*std::prev(backward))));
}

void associate_by_index(const TrajectoryView& estimate, const TrajectoryView& reference,
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
  association.matches.reserve(estimate.size());
  for (std::size_t i = 0; i < estimate.size(); ++i) association.matches.push_back({i, i, 0});
}

void associate_by_stamp(const TrajectoryView& estimate, const TrajectoryView& reference,
                        Association& association) {
  const double offset_s = association.options.time_offset_s;
  const Nanoseconds offset = to_nanoseconds(offset_s);
  const bool estimate_drives = estimate.size() <= reference.size();
  const SecondsOfEvo driving(estimate_drives ? estimate : reference, 0);
  // As evo does it: the longer one is moved, whichever that is.
  Nearest nearest(estimate_drives ? SecondsOfEvo(reference, -offset_s)
                                  : SecondsOfEvo(estimate, offset_s));
  const auto difference = [&](const Match& match) {
    return Nanoseconds{estimate.stamps[match.estimate].nanoseconds} + offset -
           Nanoseconds{reference.stamps[match.reference].nanoseconds};
  };

  association.matches.reserve(driving.size());
  Nanoseconds closest = std::numeric_limits<Nanoseconds>::max();
  for (std::size_t k = 0; k < driving.size(); ++k) {
    const Nearest::Found found = nearest(driving[k]);
    Match match;
    match.estimate = estimate_drives ? k : found.index;
    match.reference = estimate_drives ? found.index : k;
    match.time_difference_s = to_seconds(difference(match));
    closest = std::min(closest, magnitude(difference(match)));
    if (found.difference_s <= association.options.max_time_difference_s) {
      association.matches.push_back(match);
    }
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

Association associate(const TrajectoryView& estimate, const TrajectoryView& reference,
                      const AssociationOptions& options) {
  require_usable(options);
  if (estimate.empty() || reference.empty()) {
    throw EvaluationError(
        fmt::format("the {} has no pose", estimate.empty() ? "estimate" : "reference"));
  }
  if (estimate.is_stamped != reference.is_stamped) {
    throw EvaluationError(
        fmt::format("the {} has stamps and the {} has none: poses can be matched by stamp or by "
                    "index, not by both",
                    estimate.is_stamped ? "estimate" : "reference",
                    estimate.is_stamped ? "reference" : "estimate"));
  }
  Association association;
  association.options = options;
  if (!estimate.is_stamped) {
    associate_by_index(estimate, reference, association);
  } else {
    require_ordered(estimate, "estimate");
    require_ordered(reference, "reference");
    associate_by_stamp(estimate, reference, association);
  }
  return association;
}

MatchedPoses matched_poses(const TrajectoryView& estimate, const TrajectoryView& reference,
                           std::span<const Match> matches) {
  return {{matches.size(),
           [poses = estimate.poses, matches](std::size_t k) { return poses[matches[k].estimate]; }},
          {matches.size(), [poses = reference.poses, matches](std::size_t k) {
             return poses[matches[k].reference];
           }}};
}

}  // namespace traverse::evaluation
