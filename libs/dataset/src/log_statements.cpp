#include "log_statements.hpp"

namespace traverse::dataset {

using config::Binder;
using config::Range;

namespace {

constexpr std::array<std::pair<std::string_view, AngularUnit>, 2> kAngularUnits{
    {{"rad", AngularUnit::kRadians}, {"deg", AngularUnit::kDegrees}}};
constexpr std::array<std::pair<std::string_view, PulseCount>, 2> kPulseCounts{
    {{"interval", PulseCount::kInterval}, {"cumulative", PulseCount::kCumulative}}};

void bind_columns(Binder& b, std::string_view key, CsvColumns& columns, std::string_view which) {
  b.group(key, which, [&](Binder& group) {
    group.text("file", columns.file, "CSV file with a header line, relative to the folder");
    group.text("time", columns.time, "column of the time");
    group.text("columns", columns.columns, "names of the columns, blanks between");
  });
}

}  // namespace

void bind(Binder& b, LogStatements& log) {
  b.choice("angular_rate", log.angular_rate, kAngularUnits, "unit of the gyro, a second");
  b.choice("pulses", log.pulses, kPulseCounts, "since the line before, or since some beginning");
  b.number("time_unit_s", log.time_unit_s, Range::positive(), "seconds that a 1 in the time means");
}

void bind(Binder& b, CsvStatements& csv) {
  bind_columns(b, "gyro", csv.gyro, "x y z");
  bind_columns(b, "accelerometer", csv.accelerometer, "x y z, m/s^2");
  bind_columns(b, "gnss", csv.gnss, "latitude longitude altitude, and heading where it is told");
  bind_columns(b, "wheels", csv.wheels, "forward speeds, m/s");
  bind_columns(b, "reference", csv.reference, "x y z qw qx qy qz of the body, ECEF");
  b.choice("angular_rate", csv.angular_rate, kAngularUnits, "unit of the gyro, a second");
  b.number("time_unit_s", csv.time_unit_s, Range::positive(), "seconds that a 1 in the time means");
}

}  // namespace traverse::dataset
