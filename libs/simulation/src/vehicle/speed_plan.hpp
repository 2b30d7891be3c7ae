#pragma once

#include <vector>

#include "traverse/simulation/route.hpp"

namespace traverse::simulation {

/// Metres along the route at equal steps of time: speeds as the corners allow, stops, and jerk that
/// is bounded because acceleration is a running mean.
struct SpeedPlan {
  static constexpr double kStep = 0.02;  ///< seconds
  std::vector<double> progress_m;
};

SpeedPlan plan_speed(const Route& route, const RouteSettings& settings);

}  // namespace traverse::simulation
