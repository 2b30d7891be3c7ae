#include "traverse/simulation/uniform_spline.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace traverse::simulation {
namespace {

std::vector<double> samples(double step, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(std::sin(0.7 * step * i) + 0.1 * step * i);
  return values;
}

TEST(UniformSpline, DerivativesAreThoseOfItsValues) {
  const UniformSpline spline(samples(0.5, 40), 0.5, UniformSpline::Ends::kConstant);
  constexpr double h = 1e-4;
  for (double x = 2; x < 15; x += 0.37) {
    const auto at = spline.at(x);
    const auto before = spline.at(x - h);
    const auto after = spline.at(x + h);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(at[k + 1], (after[k] - before[k]) / (2 * h), 1e-6)
          << x << " derivative " << k + 1;
    }
  }
}

TEST(UniformSpline, IsSmoothAcrossKnotsAndReproducesLines) {
  const UniformSpline spline(samples(0.5, 40), 0.5, UniformSpline::Ends::kConstant);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(spline.at(5 - 1e-9)[k], spline.at(5 + 1e-9)[k], 1e-6);
  }
  std::vector<double> line;
  for (int i = 0; i < 20; ++i) line.push_back(3 + 2 * i);
  const UniformSpline straight(line, 1, UniformSpline::Ends::kConstant);
  EXPECT_NEAR(straight.at(7.3)[0], 3 + 2 * 7.3, 1e-12);
  EXPECT_NEAR(straight.at(7.3)[1], 2, 1e-12);
}

TEST(UniformSpline, PeriodicEndsMeet) {
  const UniformSpline ring({0, 1, 2, 3, 2, 1}, 1, UniformSpline::Ends::kPeriodic);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(ring.at(0.4)[k], ring.at(6.4)[k], 1e-12);
}

TEST(Jet, ArithmeticDifferentiatesTwice) {
  // f(t) = sin(t)^2 sqrt(1 + t^2) / (2 + cos t), by finite differences.
  const auto f = [](const auto& t) {
    using std::cos;
    using std::sin;
    using std::sqrt;
    return sin(t) * sin(t) * sqrt(1.0 + t * t) / (2.0 + cos(t));
  };
  constexpr double h = 1e-4;
  for (const double t : {0.3, 1.1, -2.0}) {
    const Jet jet = f(Jet(t, 1, 0));
    EXPECT_NEAR(jet.value, f(t), 1e-14);
    EXPECT_NEAR(jet.rate, (f(t + h) - f(t - h)) / (2 * h), 1e-7);
    EXPECT_NEAR(jet.bend, (f(t + h) - 2 * f(t) + f(t - h)) / (h * h), 1e-6);
  }
}

}  // namespace
}  // namespace traverse::simulation
