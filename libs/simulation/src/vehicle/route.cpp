#include "traverse/simulation/route.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "rounded_line.hpp"
#include "wander.hpp"

namespace traverse::simulation {

using config::Range;

namespace {

constexpr double kControlEvery = 2;  ///< metres: corners begin over about three of them
constexpr double kBeyondEnds = 60;   ///< metres of straight road before and after an open route

std::vector<Eigen::Vector2d> waypoints_of(const RouteSettings& settings) {
  const auto& numbers = settings.waypoints_m;
  const std::size_t least = settings.closed ? 3 : 2;
  if (numbers.size() % 2 != 0 || numbers.size() < 2 * least) {
    throw ImpossibleRoute("waypoints_m", fmt::format("x and y of at least {} points", least),
                          fmt::format("{} numbers", numbers.size()));
  }
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < numbers.size(); i += 2)
    points.emplace_back(numbers[i], numbers[i + 1]);
  return points;
}

/// What is kept of a place and a drive grows with their length.
void require_reasonable(const RouteSettings& s, double lap_m) {
  constexpr double kLongestLap_m = 100e3;
  constexpr double kLongest_s = 200e3;
  if (!(lap_m <= kLongestLap_m)) {
    throw ImpossibleRoute("waypoints_m",
                          fmt::format("a lap of at most {:.0f} km", kLongestLap_m / 1000),
                          fmt::format("{:g} km", lap_m / 1000));
  }
  const double laps = s.closed ? static_cast<double>(s.laps) : 1;
  const double driven_s = laps * lap_m / s.speed_mps;
  const double halted_s = laps * s.stop_s * static_cast<double>(s.stops_m.size());
  if (!(driven_s + halted_s <= kLongest_s)) {
    throw ImpossibleRoute("laps", fmt::format("laps that take at most {:.0f} s", kLongest_s),
                          fmt::format("{:g} of {:g} s", laps, (driven_s + halted_s) / laps));
  }
}

/// Straight road before the first and behind the last waypoint.
void extend(std::vector<Eigen::Vector2d>& points) {
  const Eigen::Vector2d first = (points[1] - points[0]).normalized();
  const Eigen::Vector2d last = (points.back() - points[points.size() - 2]).normalized();
  points.front() -= kBeyondEnds * first;
  points.back() += kBeyondEnds * last;
}

}  // namespace

void bind(config::Binder& b, RouteSettings& s) {
  b.numbers("waypoints_m", s.waypoints_m, "x and y of each corner in turn, metres east and north");
  b.flag("closed", s.closed, "the last corner leads to the first");
  b.integer("laps", s.laps, Range::between(1, 1000), "of a closed route");
  b.number("corner_radius_m", s.corner_radius_m, Range::between(1, 10000),
           "of the rounded corners");
  b.number("speed_mps", s.speed_mps, Range::between(0.1, 80), "where no corner asks for less");
  b.number("acceleration_mps2", s.acceleration_mps2, Range::between(0.05, 20),
           "largest acceleration forwards");
  b.number("braking_mps2", s.braking_mps2, Range::between(0.05, 20), "largest deceleration");
  b.number("lateral_mps2", s.lateral_mps2, Range::between(0.05, 20),
           "largest lateral acceleration");
  b.number("jerk_mps3", s.jerk_mps3, Range::between(0.05, 100), "largest jerk along the road");
  b.numbers("stops_m", s.stops_m, "metres along each lap where the vehicle halts");
  b.number("stop_s", s.stop_s, Range::between(0, 3600), "duration of each halt");
  b.number("standstill_s", s.standstill_s, Range::between(0, 3600),
           "duration of the stand-still at the start and at the end");
  b.number("wander_m", s.wander_m, Range::between(0, 5),
           "largest distance of another drive (drive_seed) from this line");
}

ImpossibleRoute::ImpossibleRoute(std::string k, std::string e, std::string f)
    : std::runtime_error(k + ": expected " + e + ", found " + f),
      key(std::move(k)),
      expected(std::move(e)),
      found(std::move(f)) {}

Route::Route(const RouteSettings& settings, std::optional<std::uint64_t> other_drive) {
  std::vector<Eigen::Vector2d> points = waypoints_of(settings);
  if (!settings.closed) {
    RoundedLine(points, false, settings.corner_radius_m);  // corners must fit without the extension
    extend(points);
  }
  const RoundedLine line(points, settings.closed, settings.corner_radius_m);

  require_reasonable(settings, line.length());
  const auto pieces = static_cast<std::size_t>(std::ceil(line.length() / kControlEvery));
  const double step = line.length() / static_cast<double>(pieces);
  std::vector<double> x, y;
  for (std::size_t i = 0; i < pieces + (settings.closed ? 0 : 1); ++i) {
    const Eigen::Vector2d p = line.at(step * static_cast<double>(i));
    x.push_back(p.x());
    y.push_back(p.y());
  }
  const auto ends =
      settings.closed ? UniformSpline::Ends::kPeriodic : UniformSpline::Ends::kConstant;
  if (other_drive) {
    const Wander wander(line.length(), settings.wander_m, *other_drive);
    const UniformSpline straight_x(x, step, ends);
    const UniformSpline straight_y(y, step, ends);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double s = step * static_cast<double>(i);
      const Eigen::Vector2d ahead =
          Eigen::Vector2d(straight_x.at(s)[1], straight_y.at(s)[1]).normalized();
      x[i] -= wander.left_m(s) * ahead.y();
      y[i] += wander.left_m(s) * ahead.x();
    }
  }
  x_ = UniformSpline(std::move(x), step, ends);
  y_ = UniformSpline(std::move(y), step, ends);

  // The spline's own ends are not straight for three controls; the drive stays clear of them.
  begin_m_ = settings.closed ? 0 : kBeyondEnds;
  lap_m_ = line.length() - 2 * begin_m_;
  length_m_ = lap_m_ * (settings.closed ? settings.laps : 1);
  for (const double stop : settings.stops_m) {
    if (stop > 0 && stop < lap_m_) continue;
    throw ImpossibleRoute("stops_m", fmt::format("places within the lap, 0 to {:.1f} m", lap_m_),
                          fmt::format("{:g}", stop));
  }
}

Route::Place Route::at(const Jet& s) const {
  const auto x = x_.at(begin_m_ + s.value);
  const auto y = y_.at(begin_m_ + s.value);
  return {chain(s, x[0], x[1], x[2]), chain(s, y[0], y[1], y[2]), chain(s, x[1], x[2], x[3]),
          chain(s, y[1], y[2], y[3])};
}

Eigen::Vector2d Route::point(double s) const {
  return {x_.at(begin_m_ + s)[0], y_.at(begin_m_ + s)[0]};
}

double Route::heading(double s) const {
  return std::atan2(y_.at(begin_m_ + s)[1], x_.at(begin_m_ + s)[1]);
}

double Route::curvature(double s) const {
  const auto x = x_.at(begin_m_ + s);
  const auto y = y_.at(begin_m_ + s);
  return (x[1] * y[2] - y[1] * x[2]) / std::pow(std::hypot(x[1], y[1]), 3);
}

}  // namespace traverse::simulation
