#include "speed_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace traverse::simulation {

namespace {

constexpr double kGrid = 0.5;  ///< metres
/// Seconds: the spline through the plan moves a little before and after the plan does.
constexpr double kSettling = 0.6;

/// The largest speed at each grid point, as the corners allow and brakes and engine can follow.
std::vector<double> speeds(const Route& route, const RouteSettings& s, std::size_t count,
                           double step) {
  std::vector<double> speed(count, s.speed_mps);
  for (std::size_t i = 0; i < count; ++i) {
    const double curvature = std::abs(route.curvature(step * static_cast<double>(i)));
    if (curvature > 0) speed[i] = std::min(speed[i], std::sqrt(s.lateral_mps2 / curvature));
  }
  speed.front() = speed.back() = 0;
  for (double lap = 0; lap < route.length_m(); lap += route.lap_m()) {
    for (const double stop : s.stops_m) {
      const auto i = static_cast<std::size_t>(std::lround((lap + stop) / step));
      if (i < count) speed[i] = 0;
    }
  }
  const auto reachable = [&](double from, double rate) {
    return std::sqrt(from * from + 2 * rate * step);
  };
  for (std::size_t i = 1; i < count; ++i) {
    speed[i] = std::min(speed[i], reachable(speed[i - 1], s.acceleration_mps2));
  }
  for (std::size_t i = count - 1; i-- > 0;) {
    speed[i] = std::min(speed[i], reachable(speed[i + 1], s.braking_mps2));
  }
  return speed;
}

/// Running mean over `width` samples (odd); what lies outside is like the nearest sample.
std::vector<double> running_mean(const std::vector<double>& values, std::size_t width) {
  const auto half = static_cast<long>(width / 2);
  const auto count = static_cast<long>(values.size());
  const auto at = [&](long i) {
    return values[static_cast<std::size_t>(std::clamp(i, 0L, count - 1))];
  };
  std::vector<double> result;
  for (long i = 0; i < count; ++i) {
    double sum = 0;
    for (long k = -half; k <= half; ++k) sum += at(i + k);
    result.push_back(sum / static_cast<double>(2 * half + 1));
  }
  return result;
}

}  // namespace

SpeedPlan plan_speed(const Route& route, const RouteSettings& settings) {
  const auto count = static_cast<std::size_t>(std::ceil(route.length_m() / kGrid)) + 1;
  const double step = route.length_m() / static_cast<double>(count - 1);
  const std::vector<double> speed = speeds(route, settings, count, step);

  // The mean stretches each start and end of a motion by half its width.
  const double width_s = (settings.acceleration_mps2 + settings.braking_mps2) / settings.jerk_mps3;
  SpeedPlan plan;
  const auto stand = [&](double metres, double seconds) {
    for (double t = 0; t < seconds; t += SpeedPlan::kStep) plan.progress_m.push_back(metres);
  };
  stand(0, settings.standstill_s + (width_s + kSettling) / 2);
  double into = 0;  // seconds since the segment's begin of the next sample
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const double begin = step * static_cast<double>(i);
    if (i > 0 && speed[i] == 0) stand(begin, settings.stop_s + width_s + kSettling);
    const double seconds = 2 * step / (speed[i] + speed[i + 1]);
    const double acceleration = (speed[i + 1] - speed[i]) / seconds;
    for (; into < seconds; into += SpeedPlan::kStep) {
      plan.progress_m.push_back(begin + into * (speed[i] + 0.5 * acceleration * into));
    }
    into -= seconds;
  }
  stand(route.length_m(), settings.standstill_s + (width_s + kSettling) / 2);
  const auto width = static_cast<std::size_t>(width_s / SpeedPlan::kStep);
  plan.progress_m = running_mean(plan.progress_m, width);
  return plan;
}

}  // namespace traverse::simulation
