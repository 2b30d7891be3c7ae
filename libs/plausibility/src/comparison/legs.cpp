#include "comparison/legs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "traverse/geometry/angle.hpp"
#include "traverse/statistics/quantile.hpp"

namespace traverse::plausibility {

namespace {

constexpr double kEarthRadius_m = 6371e3;

/// Latitude and longitude in radians.
std::optional<Eigen::Vector2d> place_of(const TimedFix& fix, PlaceReading reading) {
  const auto minutes = [](double value) {
    const double degrees = std::trunc(value);
    return degrees + (value - degrees) * 100 / 60;
  };
  Eigen::Vector2d place = geometry::kDegree * Eigen::Vector2d(fix.latitude, fix.longitude);
  if (reading == PlaceReading::kSwapped) place = Eigen::Vector2d(place.y(), place.x());
  if (reading == PlaceReading::kRadians) place = Eigen::Vector2d(fix.latitude, fix.longitude);
  if (reading == PlaceReading::kDegreesMinutes) {
    place = geometry::kDegree * Eigen::Vector2d(minutes(fix.latitude), minutes(fix.longitude));
  }
  const bool is_on_earth = std::abs(place.x()) <= std::numbers::pi / 2 + 1e-9 &&
                           std::abs(place.y()) <= 2 * std::numbers::pi + 1e-9;
  return is_on_earth ? std::optional(place) : std::nullopt;
}

struct Point {
  double t = 0;
  Eigen::Vector2d p;  // east, north of the first fix [m]
};

/// On the plane about the first fix: legs are short, and a sphere is good to half a percent.
std::vector<Point> points_of(const GnssTrack& track, PlaceReading reading, double delay_s) {
  std::vector<Point> points;
  std::optional<Eigen::Vector2d> first;
  for (const TimedFix& fix : track.fixes()) {
    const auto place = place_of(fix, reading);
    if (!place) continue;
    if (!first) first = place;
    points.push_back(
        {fix.t - delay_s,
         kEarthRadius_m * Eigen::Vector2d(std::cos(first->x()) * wrapped(place->y() - first->y()),
                                          place->x() - first->x())});
  }
  return points;
}

/// From second differences of three fixes at even distances, whose length is a Rayleigh variable of
/// sqrt(6) sigma: its median is 1.177 of that.
double noise_of(const std::vector<Point>& points) {
  std::vector<double> lengths;
  for (std::size_t i = 2; i < points.size(); ++i) {
    const double before = points[i - 1].t - points[i - 2].t;
    const double after = points[i].t - points[i - 1].t;
    if (!(after < 1.25 * before && before < 1.25 * after)) continue;
    lengths.push_back((points[i].p - 2 * points[i - 1].p + points[i - 2].p).norm());
  }
  return lengths.empty() ? 0 : statistics::median(lengths) / (1.177 * std::sqrt(6.0));
}

/// How far the middle one of three lies from where the others say it was at its time.
double deviation_m(const Point& before, const Point& point, const Point& after) {
  const double share = (point.t - before.t) / (after.t - before.t);
  return (point.p - before.p - share * (after.p - before.p)).norm();
}

/// Without those to which no vehicle drove: an outlier, of which a gate costs the estimator one
/// fix, would be two legs of a length and a turn of their own.
std::vector<Point> without_spikes(const std::vector<Point>& points, double sigma_m) {
  constexpr double kFastest_mps2 = 20;     // twice what tyres hold
  constexpr double kMaxSigmas = 8 * 1.23;  // sqrt(3/2): noise of a deviation in sigmas of a fix
  std::vector<Point> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!kept.empty() && i + 1 < points.size()) {
      const double before_s = points[i].t - kept.back().t;
      const double after_s = points[i + 1].t - points[i].t;
      const double by_driving_m = 0.5 * kFastest_mps2 * before_s * after_s;
      if (before_s + after_s > 0 && deviation_m(kept.back(), points[i], points[i + 1]) >
                                        by_driving_m + kMaxSigmas * sigma_m) {
        continue;
      }
    }
    kept.push_back(points[i]);
  }
  return kept;
}

}  // namespace

double Leg::course() const { return std::atan2(way_m.y(), way_m.x()); }

double wrapped(double angle) {
  return angle - 2 * std::numbers::pi * std::round(angle / (2 * std::numbers::pi));
}

Legs legs_of(const GnssTrack& track, PlaceReading reading, double delay_s) {
  constexpr double kMinLength_m = 2;
  constexpr double kMinSigmas = 25;
  constexpr double kMaxTime_s = 10;
  std::vector<Point> points = points_of(track, reading, delay_s);
  Legs result;
  result.sigma_m = noise_of(points);
  points = without_spikes(points, result.sigma_m);
  const double length_m = std::max(kMinLength_m, kMinSigmas * result.sigma_m);
  std::size_t begin = 0;
  for (std::size_t end = 1; end < points.size(); ++end) {
    while (begin < end && points[end].t - points[begin].t > kMaxTime_s) ++begin;
    const Eigen::Vector2d way = points[end].p - points[begin].p;
    if (way.norm() < length_m) continue;
    result.legs.push_back({points[begin].t, points[end].t, way});
    begin = end;
  }
  return result;
}

std::vector<CourseTurn> all_course_turns(const Legs& legs) {
  // Over less than a second noise is as large as a turn.
  constexpr double kMinTime_s = 1;
  constexpr double kMaxTime_s = 12;
  constexpr double kReverse = 1.5;
  std::vector<CourseTurn> turns;
  std::size_t begin = 0;
  for (std::size_t end = 1; end < legs.legs.size(); ++end) {
    if (legs.legs[end - 1].t1 != legs.legs[end].t0) begin = end;
    const Leg& before = legs.legs[begin];
    const Leg& after = legs.legs[end];
    const double seconds = after.middle_s() - before.middle_s();
    if (seconds < kMinTime_s) continue;
    const double turn = wrapped(after.course() - before.course());
    if (std::abs(turn) < kReverse && seconds < kMaxTime_s) {
      turns.push_back({before.middle_s(), after.middle_s(), turn});
    }
    begin = end;
  }
  return turns;
}

std::vector<CourseTurn> course_turns(const Legs& legs) {
  // Two courses, each of two fixes: 2 sigma across the way; three times that is no noise.
  double shortest_m = 1e9;
  for (const Leg& leg : legs.legs) shortest_m = std::min(shortest_m, leg.length_m());
  const double least = std::max(0.05, 3 * 2 * legs.sigma_m / shortest_m);
  std::vector<CourseTurn> turns = all_course_turns(legs);
  std::erase_if(turns, [&](const CourseTurn& turn) { return std::abs(turn.turn) < least; });
  return turns;
}

}  // namespace traverse::plausibility
