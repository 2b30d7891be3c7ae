#include "point_clouds/point_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"

#include "point_clouds/point_names.hpp"

namespace traverse::dataset {

using files::InputError;
using files::Place;
using geometry::Stamp;

namespace {

constexpr double kLongestInterval = 2;  // seconds; more is a recording that scans were left out of
constexpr double kJitter = 1.5;         // sweeps may last so much longer than the median interval
constexpr double kLeastShare = 0.1;     // of an interval that a sector is scanned in
constexpr double kUsualInterval = 0.1;  // seconds; longer ones may be of every n-th scan
constexpr double kCoarsestStep = 1e-3;  // of a scan's span; floats of today's seconds fail
constexpr double kClockDrift = 1e-3;    // of one clock against another
constexpr double kSameSpan = 0.1;       // two columns of the same times differ by less
constexpr std::array<double, 4> kUnits{1.0, 1e-3, 1e-6, 1e-9};

std::string name_of_unit(double unit_s) {
  if (unit_s == 1.0) return "seconds";
  if (unit_s == 1e-3) return "milliseconds";
  if (unit_s == 1e-6) return "microseconds";
  if (unit_s == 1e-9) return "nanoseconds";
  return fmt::format("units of {:g} s", unit_s);
}

/// Times of the returns of one scan, in the stored unit.
struct TimeSpan {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  bool is_single = false;  ///< stored as float32
  Stamp stamp;

  double length() const { return most - least; }
  double largest() const { return std::max(std::abs(least), std::abs(most)); }
  double step() const { return is_single ? largest() * std::numeric_limits<float>::epsilon() : 0; }
};

TimeSpan span_of(const PointSample& sample, const TimeColumn& time,
                 const std::vector<bool>& returns) {
  TimeSpan span;
  span.stamp = sample.stamp;
  span.is_single = time.column->type == ScalarType::kFloat;
  const std::vector<double> values = doubles_of(sample.points, *time.column);
  std::vector<double> rest;
  if (time.nanoseconds != nullptr) rest = doubles_of(sample.points, *time.nanoseconds);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = values[i] + (rest.empty() ? 0 : 1e-9 * rest[i]);
    if (!returns[i] || !std::isfinite(value)) continue;
    span.least = std::min(span.least, value);
    span.most = std::max(span.most, value);
  }
  return span;
}

/// What one column, or pair, comes to.
struct TimeVerdict {
  std::optional<PointTimeRule> rule;
  double span_s = 0;  ///< of the scan that is told of
  std::string why;    ///< or why not
};

/// Judges the columns of one name in all samples.
class TimeJudge {
 public:
  TimeJudge(std::vector<TimeSpan> spans, std::string name, const PointFieldHints& hints)
      : spans_(std::move(spans)),
        name_(std::move(name)),
        hints_(hints),
        interval_s_(std::min(hints.scan_interval_s, kLongestInterval)),
        longest_s_(kJitter * interval_s_),
        shortest_s_(kLeastShare * std::min(interval_s_, kUsualInterval)) {}

  TimeVerdict verdict(std::optional<double> named_unit_s) {
    TimeVerdict verdict;
    std::erase_if(spans_, [](const TimeSpan& span) { return !(span.length() > 0); });
    if (spans_.empty()) {
      verdict.why = fmt::format("'{}' is the same for all points", name_);
      return verdict;
    }
    const TimeSpan& shown = spans_.front();
    if (!most([](const TimeSpan& span) { return span.step() <= kCoarsestStep * span.length(); })) {
      verdict.why = fmt::format("'{}' has steps of {:.2g} in a span of {:.2g}", name_, shown.step(),
                                shown.length());
      return verdict;
    }
    const auto unit_s = find_unit(named_unit_s, verdict.why);
    if (!unit_s) return verdict;
    const auto zero = find_zero(*unit_s);
    if (!zero) {
      verdict.why = fmt::format(
          "'{}' counts neither from the scans' stamps nor on a clock that goes as they do", name_);
      return verdict;
    }
    PointTimeRule rule;
    rule.field = name_;
    rule.unit_s = *unit_s;
    rule.zero = *zero;
    rule.longest_s = 2 * longest_s_;  // two sweeps in one scan are well told apart yet
    verdict.rule = rule;
    verdict.span_s = shown.length() * *unit_s;
    verdict.why = hints_.time_unit_s || hints_.time_zero
                      ? "stated: " + hints_.time_stated_in
                      : fmt::format("{:.9g} to {:.9g} in a scan, and scans are {:.4g} s apart",
                                    shown.least, shown.most, hints_.scan_interval_s);
    return verdict;
  }

 private:
  template <typename Holds>
  bool most(const Holds& holds) const {
    const auto count = std::count_if(spans_.begin(), spans_.end(), holds);
    return 2 * static_cast<std::size_t>(count) > spans_.size();
  }
  bool is_relative(const TimeSpan& span, double unit_s) const {
    return span.largest() * unit_s <= longest_s_;
  }
  bool is_absolute(const TimeSpan& span, double unit_s) const {
    return std::abs(span.least * unit_s - span.stamp.seconds()) <= longest_s_;
  }
  bool fits(const TimeSpan& span, double unit_s) const {
    const double span_s = span.length() * unit_s;
    if (span_s > longest_s_) return false;
    return span_s >= shortest_s_ || (is_absolute(span, unit_s) && !is_relative(span, unit_s));
  }

  std::optional<double> find_unit(std::optional<double> named_unit_s, std::string& why) const {
    const TimeSpan& shown = spans_.front();
    if (hints_.time_unit_s) {
      const double unit_s = *hints_.time_unit_s;
      if (most([&](const TimeSpan& span) { return span.length() * unit_s <= longest_s_; })) {
        return unit_s;
      }
      throw InputError(
          hints_.recording, Place::key(name_),
          fmt::format("times of a scan that span at most {:.4g} s, as scans are {:.4g} s apart",
                      longest_s_, hints_.scan_interval_s),
          fmt::format("{:.9g} to {:.9g}, which is {:.4g} s in the unit that is stated ({})",
                      shown.least, shown.most, shown.length() * unit_s, hints_.time_stated_in));
    }
    std::vector<double> fitting;
    for (const double unit_s : kUnits) {
      if (named_unit_s && unit_s != *named_unit_s) continue;
      if (most([&](const TimeSpan& span) { return fits(span, unit_s); })) fitting.push_back(unit_s);
    }
    if (fitting.size() == 1) return fitting.front();
    if (fitting.empty()) {
      why = fmt::format("'{}' spans {:.9g} in one scan, which {} fits scans {:.4g} s apart", name_,
                        shown.length(),
                        named_unit_s ? "not in " + name_of_unit(*named_unit_s) : "in no unit",
                        hints_.scan_interval_s);
    } else {
      why = fmt::format("'{}' may count {} or {}", name_, name_of_unit(fitting[0]),
                        name_of_unit(fitting[1]));
    }
    return std::nullopt;
  }

  std::optional<TimeZero> find_zero(double unit_s) const {
    if (hints_.time_zero) return hints_.time_zero;
    const auto relative = std::count_if(spans_.begin(), spans_.end(), [&](const TimeSpan& span) {
      return is_relative(span, unit_s);
    });
    const auto absolute = std::count_if(spans_.begin(), spans_.end(), [&](const TimeSpan& span) {
      return is_absolute(span, unit_s);
    });
    const auto half = static_cast<std::ptrdiff_t>(spans_.size());
    if (2 * std::max(relative, absolute) > half) {
      return relative >= absolute ? TimeZero::kScanStamp : TimeZero::kEpoch;
    }
    std::size_t pairs = 0;
    std::size_t as_stamps = 0;
    for (std::size_t i = 0; i + 1 < spans_.size(); ++i) {
      const double passed_s = geometry::seconds_between(spans_[i].stamp, spans_[i + 1].stamp);
      const double told_s = (spans_[i + 1].least - spans_[i].least) * unit_s;
      ++pairs;
      if (std::abs(told_s - passed_s) <= longest_s_ + kClockDrift * std::abs(passed_s)) ++as_stamps;
    }
    if (2 * as_stamps >= pairs) return TimeZero::kSweepStart;
    return std::nullopt;
  }

  std::vector<TimeSpan> spans_;
  std::string name_;
  const PointFieldHints& hints_;
  double interval_s_;
  double longest_s_;
  double shortest_s_;
};

std::string describe(const PointTimeRule& rule) {
  const std::string field =
      rule.nanoseconds.empty()
          ? fmt::format("field '{}', {}, ", rule.field, name_of_unit(rule.unit_s))
          : fmt::format("fields '{}' and '{}', seconds and nanoseconds, ", rule.field,
                        rule.nanoseconds);
  switch (rule.zero) {
    case TimeZero::kScanStamp:
      return field + "after the scan's stamp";
    case TimeZero::kEpoch:
      return field + "absolute";
    case TimeZero::kSweepStart:
      return field + "absolute on another clock: a scan's first point is at its stamp";
    case TimeZero::kSweepMiddle:
      return field + "differences alone: a scan's middle is at its stamp";
    case TimeZero::kSweepEnd:
      return field + "differences alone: a scan's last point is at its stamp";
  }
  return field;
}

constexpr const char* kHowToState =
    "; state it: --recording lidar.time_field=NAME, lidar.time_unit=s, ms, us or ns, "
    "lidar.time_zero=stamp, epoch, start, middle or end";

/// The columns that may hold times: the one that is stated, or those of a name that is known.
std::vector<TimeColumn> candidates_in(std::span<const PointSample> samples,
                                      const PointFieldHints& hints) {
  if (hints.time_field.empty()) {
    for (const PointSample& sample : samples) {
      if (auto found = time_columns(sample.points); !found.empty()) return found;
    }
    return {};
  }
  for (const PointSample& sample : samples) {
    for (const TimeColumn& known : time_columns(sample.points)) {
      if (known.nanoseconds != nullptr && known.column->name == hints.time_field) return {known};
    }
    for (const PointColumn& column : sample.points.columns) {
      if (plain_name(column.name) == plain_name(hints.time_field)) {
        return {TimeColumn{&column, nullptr, std::nullopt}};
      }
    }
  }
  throw InputError(hints.recording, Place::key("lidar.time_field"), "a field of the points",
                   files::in_quotes(hints.time_field));
}

const PointColumn* same_column(const PointColumns& points, const PointColumn& wanted) {
  if (const PointColumn* column = points.find(wanted.name)) return column;
  for (const PointColumn& column : points.columns) {
    if (plain_name(column.name) == plain_name(wanted.name)) return &column;
  }
  return nullptr;
}

TimeVerdict judge(std::span<const PointSample> samples, std::span<const std::vector<bool>> returns,
                  const TimeColumn& time, const PointFieldHints& hints) {
  std::vector<TimeSpan> spans;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const PointColumns& points = samples[i].points;
    TimeColumn here{same_column(points, *time.column), nullptr, {}};
    if (time.nanoseconds != nullptr) here.nanoseconds = same_column(points, *time.nanoseconds);
    if (here.column == nullptr) continue;
    if (time.nanoseconds != nullptr && here.nanoseconds == nullptr) continue;
    spans.push_back(span_of(samples[i], here, returns[i]));
  }
  TimeVerdict verdict = TimeJudge(std::move(spans), time.column->name, hints).verdict(time.unit_s);
  if (verdict.rule && time.nanoseconds != nullptr) {
    verdict.rule->nanoseconds = time.nanoseconds->name;
  }
  return verdict;
}

bool is_same_span(double a, double b) { return std::abs(a - b) <= kSameSpan * std::max(a, b); }

bool is_return(const sensors::LidarScan& scan, std::size_t i) {
  return std::isfinite(scan.x[i] + scan.y[i] + scan.z[i]) &&
         (scan.x[i] != 0 || scan.y[i] != 0 || scan.z[i] != 0);
}

/// Whole numbers of whole nanoseconds stay exact. Nothing for what no stamp can hold.
template <typename Number>
std::optional<Stamp> absolute_stamp(Number value, double unit_s) {
  constexpr double kLargestSeconds = 9e9;
  const double seconds = static_cast<double>(value) * unit_s;
  if (!(std::abs(seconds) < kLargestSeconds)) return std::nullopt;
  const double nanoseconds = std::round(unit_s * 1e9);
  if (std::is_integral_v<Number> && nanoseconds >= 1 && unit_s == nanoseconds * 1e-9) {
    return Stamp{static_cast<std::int64_t>(value) * static_cast<std::int64_t>(nanoseconds)};
  }
  return Stamp::from_seconds(seconds);
}

const PointColumn& time_column(const PointColumns& points, const std::string& name,
                               const std::filesystem::path& where) {
  PointColumn wanted;
  wanted.name = name;
  if (const PointColumn* column = same_column(points, wanted)) return *column;
  throw InputError(where, Place::whole_file(), "a field '" + name + "' as in the other scans",
                   "none");
}

std::vector<std::optional<Stamp>> absolute_stamps(const PointColumns& points,
                                                  const PointTimeRule& rule,
                                                  const std::filesystem::path& where) {
  const FieldValues values = values_of(points, time_column(points, rule.field, where));
  std::vector<std::optional<Stamp>> stamps(points.points);
  std::visit(
      [&](const auto& held) {
        std::transform(held.begin(), held.end(), stamps.begin(),
                       [&](auto value) { return absolute_stamp(value, rule.unit_s); });
      },
      values);
  if (rule.nanoseconds.empty()) return stamps;
  const std::vector<double> rest = doubles_of(points, time_column(points, rule.nanoseconds, where));
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (!stamps[i]) continue;
    if (std::abs(rest[i]) < 1e18) {
      stamps[i]->nanoseconds += static_cast<std::int64_t>(rest[i]);
    } else {
      stamps[i].reset();
    }
  }
  return stamps;
}

/// The moment that times are counted from.
Stamp zero_of(const std::vector<std::optional<Stamp>>& stamps, TimeZero zero,
              const sensors::LidarScan& scan) {
  if (zero == TimeZero::kEpoch) return scan.stamp;
  if (zero == TimeZero::kScanStamp) return {};
  std::optional<Stamp> first;
  std::optional<Stamp> last;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (!stamps[i] || !is_return(scan, i)) continue;
    if (!first || *stamps[i] < *first) first = stamps[i];
    if (!last || *stamps[i] > *last) last = stamps[i];
  }
  if (!first) return scan.stamp;
  if (zero == TimeZero::kSweepStart) return *first;
  if (zero == TimeZero::kSweepEnd) return *last;
  return {first->nanoseconds + (last->nanoseconds - first->nanoseconds) / 2};
}

/// Seconds after `zero`.
std::vector<float> seconds_after(Stamp zero, const std::vector<std::optional<Stamp>>& stamps) {
  std::vector<float> times(stamps.size());
  std::transform(stamps.begin(), stamps.end(), times.begin(), [&](const auto& point) {
    return point ? static_cast<float>(geometry::seconds_between(zero, *point))
                 : std::numeric_limits<float>::quiet_NaN();
  });
  return times;
}

/// From first to last of the returns; first above last if no return has a time.
struct FirstAndLast {
  float first = std::numeric_limits<float>::infinity();
  float last = -std::numeric_limits<float>::infinity();
  bool are_there() const { return first <= last; }
};

FirstAndLast first_and_last(const std::vector<float>& times, const sensors::LidarScan& scan) {
  FirstAndLast ends;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (std::isnan(times[i]) || !is_return(scan, i)) continue;
    ends.first = std::min(ends.first, times[i]);
    ends.last = std::max(ends.last, times[i]);
  }
  return ends;
}

}  // namespace

std::optional<PointTimeRule> find_point_time(std::span<const PointSample> samples,
                                             std::span<const std::vector<bool>> returns,
                                             const PointFieldHints& hints,
                                             std::vector<Fact>& facts) {
  const std::vector<TimeColumn> candidates = candidates_in(samples, hints);
  if (candidates.empty()) {
    for (const PointColumn& other : samples.front().points.columns) {
      if (!sounds_like_time(other.name)) continue;
      facts.push_back({"time field", "none",
                       fmt::format("'{}' sounds like one, but is not known; if it is one, state "
                                   "it: --recording lidar.time_field={}",
                                   other.name, other.name)});
      break;
    }
    return std::nullopt;
  }
  std::optional<TimeVerdict> chosen;
  std::string why_not;
  for (const TimeColumn& candidate : candidates) {
    TimeVerdict verdict = judge(samples, returns, candidate, hints);
    if (!verdict.rule) {
      if (why_not.empty()) why_not = verdict.why;
    } else if (!chosen) {
      chosen = std::move(verdict);
    } else if (!is_same_span(chosen->span_s, verdict.span_s)) {
      facts.push_back({"time field", "not used",
                       fmt::format("'{}' and '{}' both fit and do not agree: {:.4g} and {:.4g} s "
                                   "in a scan{}",
                                   chosen->rule->field, verdict.rule->field, chosen->span_s,
                                   verdict.span_s, kHowToState)});
      return std::nullopt;
    }
  }
  if (!chosen) {
    facts.push_back({"time field", "not used", why_not + kHowToState});
    return std::nullopt;
  }
  facts.push_back({"time field", describe(*chosen->rule), chosen->why});
  return chosen->rule;
}

std::vector<float> point_times(const PointColumns& points, const PointTimeRule& rule,
                               const sensors::LidarScan& scan, const std::filesystem::path& where) {
  std::vector<float> times;
  if (rule.zero == TimeZero::kScanStamp && rule.nanoseconds.empty()) {
    times.reserve(points.points);
    for (const double value : doubles_of(points, time_column(points, rule.field, where))) {
      times.push_back(static_cast<float>(value * rule.unit_s));
    }
  } else {
    const auto stamps = absolute_stamps(points, rule, where);
    times = seconds_after(zero_of(stamps, rule.zero, scan), stamps);
    if (rule.zero == TimeZero::kEpoch) {
      // Stamps that were moved where the clock was set do not go with the points' times any more.
      const FirstAndLast ends = first_and_last(times, scan);
      if (ends.are_there() &&
          std::max(std::abs(ends.first), std::abs(ends.last)) > rule.longest_s) {
        times = seconds_after(zero_of(stamps, TimeZero::kSweepStart, scan), stamps);
      }
    }
  }
  const FirstAndLast ends = first_and_last(times, scan);
  if (ends.are_there() && double{ends.last} - double{ends.first} > rule.longest_s) {
    throw InputError(where, Place::key(rule.field),
                     fmt::format("times of one scan, {:.4g} s at most", rule.longest_s),
                     fmt::format("{:.4g} to {:.4g} s", ends.first, ends.last));
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (std::abs(times[i]) > rule.longest_s && !is_return(scan, i)) {
      times[i] = std::numeric_limits<float>::quiet_NaN();  // some drivers write 0 for no return
    }
  }
  return times;
}

}  // namespace traverse::dataset
