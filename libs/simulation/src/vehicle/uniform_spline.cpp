#include "traverse/simulation/uniform_spline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace traverse::simulation {

namespace {

/// Row k: coefficients of 1, t, .. t^5 of the weight of control value floor(x) + k - 2, times 120.
constexpr std::array<std::array<double, 6>, 6> kWeights{{{1, -5, 10, -10, 5, -1},
                                                         {26, -50, 20, 20, -20, 5},
                                                         {66, 0, -60, 0, 30, -10},
                                                         {26, 50, 20, -20, -20, 10},
                                                         {1, 5, 10, 10, 5, -5},
                                                         {0, 0, 0, 0, 0, 1}}};

}  // namespace

UniformSpline::UniformSpline(std::vector<double> controls, double step, Ends ends)
    : controls_(std::move(controls)), step_(step), ends_(ends) {}

double UniformSpline::control(long i) const {
  const auto count = static_cast<long>(controls_.size());
  const long index =
      ends_ == Ends::kPeriodic ? ((i % count) + count) % count : std::clamp(i, 0L, count - 1);
  return controls_[static_cast<std::size_t>(index)];
}

std::array<double, 4> UniformSpline::at(double x) const {
  const double u = x / step_;
  const double knot = std::floor(u);
  const double t = u - knot;
  std::array<double, 6> polynomial{};
  for (std::size_t k = 0; k < 6; ++k) {
    const double c = control(static_cast<long>(knot) + static_cast<long>(k) - 2) / 120;
    for (std::size_t power = 0; power < 6; ++power) polynomial[power] += c * kWeights[k][power];
  }
  std::array<double, 4> result{};
  double scale = 1;
  for (double& derivative : result) {
    for (std::size_t power = 6; power-- > 0;) derivative = derivative * t + polynomial[power];
    derivative *= scale;
    scale /= step_;
    for (std::size_t power = 0; power < 5; ++power) {
      polynomial[power] = static_cast<double>(power + 1) * polynomial[power + 1];
    }
    polynomial[5] = 0;
  }
  return result;
}

Jet UniformSpline::operator()(const Jet& x) const {
  const auto d = at(x.value);
  return chain(x, d[0], d[1], d[2]);
}

}  // namespace traverse::simulation
