#include "recording/measurement_statements.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "recording/statements.hpp"

namespace traverse::dataset {

namespace {

constexpr double kStandardGravity = 9.80665;  // m/s^2 of one g, by definition
constexpr double kRadian_deg = 180 / std::numbers::pi;

constexpr std::array<std::pair<std::string_view, ForceUnit>, 4> kForceUnits{
    {{"m_s2", ForceUnit::kMetres},
     {"g", ForceUnit::kG},
     {"mg", ForceUnit::kMilliG},
     {"increment", ForceUnit::kIncrement}}};
constexpr std::array<std::pair<std::string_view, RateUnit>, 3> kRateUnits{
    {{"rad", RateUnit::kRadians},
     {"deg", RateUnit::kDegrees},
     {"increment", RateUnit::kIncrement}}};
constexpr std::array<std::pair<std::string_view, PlaceOrder>, 2> kPlaceOrders{
    {{"latitude_longitude", PlaceOrder::kLatitudeFirst},
     {"longitude_latitude", PlaceOrder::kLongitudeFirst}}};
constexpr std::array<std::pair<std::string_view, PlaceUnit>, 3> kPlaceUnits{
    {{"deg", PlaceUnit::kDegrees},
     {"rad", PlaceUnit::kRadians},
     {"ddmm", PlaceUnit::kDegreesMinutes}}};
constexpr std::array<std::pair<std::string_view, HeadingSense>, 3> kHeadingSenses{
    {{"from_north", HeadingSense::kFromNorth},
     {"from_east", HeadingSense::kFromEast},
     {"counterclockwise", HeadingSense::kCounterclockwise}}};
constexpr std::array<std::pair<std::string_view, HeadingUnit>, 2> kHeadingUnits{
    {{"deg", HeadingUnit::kDegrees}, {"rad", HeadingUnit::kRadians}}};

/// Degrees of degrees and minutes: ddmm.mmmm as NMEA writes them, or the same over a hundred, where
/// minutes stand as decimals.
double from_minutes(double value) {
  const double hundredths = std::abs(value) > 180 ? value / 100 : value;
  const double degrees = std::trunc(hundredths);
  return degrees + (hundredths - degrees) * 100 / 60;
}

}  // namespace

void bind(config::Binder& b, ImuStatements& imu) {
  b.choice("unit", imu.unit, kForceUnits,
           "of the specific force; increment: its integral since the reading before, m/s");
  b.choice("angular_rate", imu.angular_rate, kRateUnits,
           "unit of the gyro, per second; increment: its integral since the reading before, rad");
}

void bind(config::Binder& b, GnssStatements& gnss) {
  b.choice("order", gnss.order, kPlaceOrders, "which of the two numbers of a place comes first");
  b.choice("unit", gnss.unit, kPlaceUnits,
           "of latitude and longitude; ddmm: degrees and minutes as NMEA writes them");
  b.choice("heading", gnss.heading, kHeadingSenses,
           "clockwise from north, counterclockwise from east, counterclockwise from north");
  b.choice("heading_unit", gnss.heading_unit, kHeadingUnits, "of the heading");
  b.number("delay_s", gnss.delay_s, config::Range::between(-100, 100),
           "a fix tells where the antenna was so long before its stamp");
}

bool StatedMeasurements::apply(sensors::ImuSample& sample) {
  double interval_s = 0;
  if (has_increments()) {
    const auto [last, is_first] = last_.try_emplace(sample.sensor, sample.stamp);
    interval_s = geometry::seconds_between(last->second, sample.stamp);
    last->second = sample.stamp;
    if (is_first || !(interval_s > 0)) return false;
  }
  switch (imu_.unit) {
    case ForceUnit::kMetres:
      break;
    case ForceUnit::kG:
      sample.specific_force *= kStandardGravity;
      break;
    case ForceUnit::kMilliG:
      sample.specific_force *= kStandardGravity / 1000;
      break;
    case ForceUnit::kIncrement:
      sample.specific_force /= interval_s;
      break;
  }
  if (imu_.angular_rate == RateUnit::kDegrees) sample.angular_rate /= kRadian_deg;
  if (imu_.angular_rate == RateUnit::kIncrement) sample.angular_rate /= interval_s;
  return true;
}

void StatedMeasurements::apply(sensors::GnssFix& fix) const {
  if (gnss_.order == PlaceOrder::kLongitudeFirst) std::swap(fix.latitude_deg, fix.longitude_deg);
  for (double* angle : {&fix.latitude_deg, &fix.longitude_deg}) {
    if (gnss_.unit == PlaceUnit::kRadians) *angle *= kRadian_deg;
    if (gnss_.unit == PlaceUnit::kDegreesMinutes) *angle = from_minutes(*angle);
  }
  if (fix.heading_deg) {
    double heading_deg = *fix.heading_deg;
    if (gnss_.heading_unit == HeadingUnit::kRadians) heading_deg *= kRadian_deg;
    if (gnss_.heading == HeadingSense::kFromEast) heading_deg = 90 - heading_deg;
    if (gnss_.heading == HeadingSense::kCounterclockwise) heading_deg = -heading_deg;
    fix.heading_deg = heading_deg;
  }
  if (gnss_.delay_s != 0) fix.stamp = geometry::shifted(fix.stamp, -gnss_.delay_s);
}

void add_measurement_facts(const Statements& statements, std::vector<Fact>& facts) {
  const auto add = [&](const char* key, const char* name, const std::string& value) {
    if (const auto origin = statements.origin(key)) facts.push_back({name, value, *origin});
  };
  const auto name_in = [](const auto& names, auto value) {
    for (const auto& [name, named] : names) {
      if (named == value) return std::string(name);
    }
    return std::string();
  };
  const ImuStatements& imu = statements->imu;
  const GnssStatements& gnss = statements->gnss;
  add("imu.unit", "specific force", name_in(kForceUnits, imu.unit));
  add("imu.angular_rate", "angular rates", name_in(kRateUnits, imu.angular_rate));
  add("gnss.order", "order of places", name_in(kPlaceOrders, gnss.order));
  add("gnss.unit", "unit of places", name_in(kPlaceUnits, gnss.unit));
  add("gnss.heading", "heading", name_in(kHeadingSenses, gnss.heading));
  add("gnss.heading_unit", "unit of headings", name_in(kHeadingUnits, gnss.heading_unit));
  add("gnss.delay_s", "delay of fixes", fmt::format("{:g} s", gnss.delay_s));
  add("accept", "accepted contradictions", statements->accept);
}

}  // namespace traverse::dataset
