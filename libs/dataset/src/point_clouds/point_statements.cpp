#include "point_clouds/point_statements.hpp"

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "point_clouds/point_fields.hpp"
#include "recording/statements.hpp"

namespace traverse::dataset {

namespace {

constexpr std::array<std::pair<std::string_view, StatedTimeUnit>, 5> kStatedUnits{
    {{"auto", StatedTimeUnit::kNotStated},
     {"s", StatedTimeUnit::kSeconds},
     {"ms", StatedTimeUnit::kMilliseconds},
     {"us", StatedTimeUnit::kMicroseconds},
     {"ns", StatedTimeUnit::kNanoseconds}}};
constexpr std::array<std::pair<std::string_view, StatedTimeZero>, 6> kStatedZeros{
    {{"auto", StatedTimeZero::kNotStated},
     {"stamp", StatedTimeZero::kStamp},
     {"epoch", StatedTimeZero::kEpoch},
     {"start", StatedTimeZero::kStart},
     {"middle", StatedTimeZero::kMiddle},
     {"end", StatedTimeZero::kEnd}}};

std::optional<double> seconds_of_unit(StatedTimeUnit unit) {
  switch (unit) {
    case StatedTimeUnit::kNotStated:
      return std::nullopt;
    case StatedTimeUnit::kSeconds:
      return 1.0;
    case StatedTimeUnit::kMilliseconds:
      return 1e-3;
    case StatedTimeUnit::kMicroseconds:
      return 1e-6;
    case StatedTimeUnit::kNanoseconds:
      return 1e-9;
  }
  return std::nullopt;
}

std::optional<TimeZero> zero_that_is_stated(StatedTimeZero zero) {
  switch (zero) {
    case StatedTimeZero::kNotStated:
      return std::nullopt;
    case StatedTimeZero::kStamp:
      return TimeZero::kScanStamp;
    case StatedTimeZero::kEpoch:
      return TimeZero::kEpoch;
    case StatedTimeZero::kStart:
      return TimeZero::kSweepStart;
    case StatedTimeZero::kMiddle:
      return TimeZero::kSweepMiddle;
    case StatedTimeZero::kEnd:
      return TimeZero::kSweepEnd;
  }
  return std::nullopt;
}

}  // namespace

void bind(config::Binder& b, PointFieldStatements& points) {
  b.text("ring_field", points.ring_field, "field of a point with its ring number; else by name");
  b.text("time_field", points.time_field, "field of a point with its time; else by name");
  b.choice("time_unit", points.time_unit, kStatedUnits,
           "of that field; auto: that in which a sweep fits the time to the next scan");
  b.choice("time_zero", points.time_zero, kStatedZeros,
           "what point times count from, or where in a sweep the scan's stamp is");
}

PointFieldHints stated_point_fields(const Statements& statements) {
  PointFieldHints hints;
  const PointFieldStatements& points = statements->points;
  hints.ring_field = points.ring_field;
  hints.time_field = points.time_field;
  hints.time_unit_s = seconds_of_unit(points.time_unit);
  hints.time_zero = zero_that_is_stated(points.time_zero);
  if (!hints.time_unit_s && statements.states("point_time_unit_s")) {
    hints.time_unit_s = statements->point_time_unit_s;
  }
  for (const char* key :
       {"lidar.time_unit", "point_time_unit_s", "lidar.time_zero", "lidar.time_field"}) {
    const auto origin = statements.origin(key);
    if (!origin) continue;
    if (!hints.time_stated_in.empty()) hints.time_stated_in += ", ";
    hints.time_stated_in += *origin;
  }
  return hints;
}

void note_idle_point_statements(const Statements& statements, const std::string& prefix,
                                const std::string& why, std::vector<Fact>& facts) {
  for (const char* key : {"lidar.ring_field", "lidar.time_field", "lidar.time_unit",
                          "lidar.time_zero", "point_time_unit_s"}) {
    const auto origin = statements.origin(key);
    if (!origin) continue;
    facts.push_back({fmt::format("{}{}", prefix, key), "not used",
                     fmt::format("{}; stated in {}", why, *origin)});
  }
}

}  // namespace traverse::dataset
