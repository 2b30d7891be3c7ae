#include "navigation_log/log_statements.hpp"

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"
#include "traverse/files/numbers.hpp"
#include "traverse/geometry/stamp.hpp"

namespace traverse::dataset {

using config::Binder;
using config::Range;

namespace {

constexpr std::array<std::pair<std::string_view, AngularUnit>, 2> kAngularUnits{
    {{"rad", AngularUnit::kRadians}, {"deg", AngularUnit::kDegrees}}};
constexpr std::array<std::pair<std::string_view, PulseCount>, 2> kPulseCounts{
    {{"interval", PulseCount::kInterval}, {"cumulative", PulseCount::kCumulative}}};

void bind_file(Binder& b, CsvColumns& columns) {
  b.text("file", columns.file, "CSV file with a header line, relative to the folder");
  b.text("time", columns.time, "column of the time");
  b.text("columns", columns.columns,
         "names of the columns, separated by blanks, or by commas where a name holds one");
  b.number("period_s", columns.period_s, Range::non_negative(),
           "sampling period of the sensor's clock, where readings are stamped on arrival; 0: "
           "stamps are the sensor's");
}

void bind_columns(Binder& b, std::string_view key, CsvColumns& columns, std::string_view which) {
  b.group(key, which, [&](Binder& group) { bind_file(group, columns); });
}

}  // namespace

void bind(Binder& b, LogStatements& log) {
  b.choice("angular_rate", log.angular_rate, kAngularUnits, "unit of the angular rate, per second");
  b.choice("pulses", log.pulses, kPulseCounts, "counted since the previous line, or cumulative");
  b.number("time_unit_s", log.time_unit_s, Range::positive(),
           "seconds per unit of the time column");
}

void bind(Binder& b, CsvStatements& csv) {
  bind_columns(b, "gyro", csv.gyro, "x y z");
  bind_columns(b, "accelerometer", csv.accelerometer, "x y z, m/s^2");
  bind_columns(b, "gnss", csv.gnss, "latitude longitude altitude, and heading where it is told");
  bind_columns(b, "wheels", csv.wheels, "forward speeds, m/s");
  b.group("reference", "x y z qw qx qy qz of the body, ECEF", [&](Binder& group) {
    bind_file(group, csv.reference);
    group.numbers("roll_pitch_yaw_deg", csv.reference_roll_pitch_yaw_deg,
                  "of the quaternion's axes in the body: about x, then y, then z, degrees");
  });
  b.choice("angular_rate", csv.angular_rate, kAngularUnits, "unit of the angular rate, per second");
  b.number("time_unit_s", csv.time_unit_s, Range::positive(),
           "seconds per unit of the time column");
}

std::string time_out_of_range(std::string_view time, std::string_view key) {
  const std::string found = files::in_quotes(time);
  const auto number = files::parse_double(time);
  const auto unit = number ? geometry::unix_time_unit(*number) : std::nullopt;
  if (!unit) return found;
  return fmt::format("{}, {} if it is a Unix time; say so with --recording {}={}", found,
                     name_of(*unit), key, seconds_of(*unit));
}

}  // namespace traverse::dataset
