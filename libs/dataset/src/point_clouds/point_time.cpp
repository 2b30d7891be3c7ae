#include "point_clouds/point_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"

#include "point_clouds/field_values.hpp"

namespace traverse::dataset {

using geometry::Stamp;

namespace {

constexpr double kLongestSweep = 2;         // seconds
constexpr double kLargestClockOffset = 10;  // seconds between a scan's stamp and its points
constexpr double kCoarsestStep = 1e-3;      // of a scan's span; floats of today's seconds fail
// Of PCL and Velodyne, Ouster, Hesai, Livox; CloudCompare puts "scalar_" before names.
constexpr std::array<const char*, 8> kFields{
    "time",        "t",        "timestamp",        "offset_time",
    "scalar_time", "scalar_t", "scalar_timestamp", "scalar_offset_time"};

struct Span {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  double length() const { return most - least; }
};

Span span_of(const FieldValues& field) {
  Span span;
  for (const double value : to_doubles(field)) {
    if (!std::isfinite(value)) continue;
    span.least = std::min(span.least, value);
    span.most = std::max(span.most, value);
  }
  return span;
}

/// Units are a thousand apart, so that half as long again (stamps jitter) decides nothing else.
std::optional<double> unit_of(const Span& span, const PointTimeHints& hints) {
  if (hints.stated_unit_s) return hints.stated_unit_s;
  const double longest = 1.5 * std::min(hints.scan_interval_s, kLongestSweep);
  for (const double unit : {1.0, 1e-3, 1e-6, 1e-9}) {
    if (span.length() * unit <= longest) return unit;
  }
  return std::nullopt;
}

std::string name_of_unit(double unit_s) {
  if (unit_s == 1.0) return "seconds";
  if (unit_s == 1e-3) return "milliseconds";
  if (unit_s == 1e-6) return "microseconds";
  if (unit_s == 1e-9) return "nanoseconds";
  return fmt::format("units of {:g} s", unit_s);
}

bool looks_like_time(std::string_view name) {
  for (const char* part : {"time", "Time", "TIME", "stamp", "sec"}) {
    if (name.find(part) != std::string_view::npos) return true;
  }
  return false;
}

const FieldValues* time_field(const PointCloud& cloud, const char*& name) {
  for (const char* candidate : kFields) {
    name = candidate;
    if (const FieldValues* field = cloud.find(candidate)) return field;
  }
  return nullptr;
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

std::optional<Stamp> earliest(const std::vector<std::optional<Stamp>>& stamps) {
  std::optional<Stamp> first;
  for (const auto& stamp : stamps) {
    if (stamp && (!first || *stamp < *first)) first = stamp;
  }
  return first;
}

std::string describe(const PointTimeConvention& convention) {
  std::string base =
      fmt::format("field '{}', {}, ", convention.field, name_of_unit(convention.unit_s));
  switch (convention.zero) {
    case TimeZero::kScanStamp:
      return base + "after the scan's stamp";
    case TimeZero::kEpoch:
      return base + "absolute";
    case TimeZero::kFirstPoint:
      return base + "absolute on another clock: a scan's first point is at its stamp";
  }
  return base;
}

}  // namespace

bool has_one_time(const PointCloud& cloud) {
  const char* name = nullptr;
  const FieldValues* field = time_field(cloud, name);
  return field != nullptr && cloud.size() > 1 && !(span_of(*field).length() > 0);
}

std::optional<PointTimeConvention> find_point_time(const PointCloud& cloud, Stamp stamp,
                                                   const PointTimeHints& hints,
                                                   std::vector<Fact>& facts) {
  const auto unusable = [&](const std::string& why) {
    facts.push_back({"time field", "not used", why});
    return std::nullopt;
  };
  const char* name = nullptr;
  const FieldValues* found = time_field(cloud, name);
  if (found == nullptr) {
    for (const PointCloud::Field& other : cloud.fields()) {
      if (!looks_like_time(other.name)) continue;
      facts.push_back({"time field", "none",
                       fmt::format("'{}' looks like one, but is not known: rename it to 'time' "
                                   "(seconds, milliseconds ... after the scan's stamp)",
                                   other.name)});
      break;
    }
    return std::nullopt;
  }
  const FieldValues& field = *found;
  const Span span = span_of(field);
  if (!(span.length() > 0)) return unusable(fmt::format("'{}' is the same for all points", name));
  const double largest = std::max(std::abs(span.least), std::abs(span.most));
  const bool single = type_of(field) == ScalarType::kFloat;
  const double step = single ? largest * std::numeric_limits<float>::epsilon() : 0;
  if (step > kCoarsestStep * span.length()) {
    return unusable(
        fmt::format("'{}' has steps of {:.2g} in a span of {:.2g}", name, step, span.length()));
  }
  const auto unit = unit_of(span, hints);
  if (!unit) return unusable(fmt::format("'{}' spans {} in one scan", name, span.length()));

  PointTimeConvention convention{name, *unit, TimeZero::kScanStamp};
  if (largest * *unit > kLongestSweep) {
    const double offset = span.least * *unit - stamp.seconds();
    convention.zero =
        std::abs(offset) < kLargestClockOffset ? TimeZero::kEpoch : TimeZero::kFirstPoint;
  }
  facts.push_back({"time field", describe(convention),
                   hints.stated_unit_s
                       ? "unit: " + hints.stated_in
                       : fmt::format("{:.9g} to {:.9g} in a scan, and scans are {:.4g} s apart",
                                     span.least, span.most, hints.scan_interval_s)});
  return convention;
}

std::vector<float> point_times(const PointCloud& cloud, const PointTimeConvention& convention,
                               Stamp stamp, const std::filesystem::path& file) {
  const FieldValues* field = cloud.find(convention.field);
  if (field == nullptr) {
    throw files::InputError(file, files::Place::whole_file(),
                            "a field '" + convention.field + "' as in the other scans", "none");
  }
  return std::visit(
      [&](const auto& values) {
        std::vector<float> times(values.size());
        if (convention.zero == TimeZero::kScanStamp) {
          std::transform(values.begin(), values.end(), times.begin(), [&](auto value) {
            return static_cast<float>(static_cast<double>(value) * convention.unit_s);
          });
          return times;
        }
        std::vector<std::optional<Stamp>> stamps(values.size());
        std::transform(values.begin(), values.end(), stamps.begin(),
                       [&](auto value) { return absolute_stamp(value, convention.unit_s); });
        const Stamp zero =
            convention.zero == TimeZero::kEpoch ? stamp : earliest(stamps).value_or(stamp);
        std::transform(stamps.begin(), stamps.end(), times.begin(), [&](const auto& point) {
          return point ? static_cast<float>(geometry::seconds_between(zero, *point))
                       : std::numeric_limits<float>::quiet_NaN();
        });
        return times;
      },
      *field);
}

}  // namespace traverse::dataset
