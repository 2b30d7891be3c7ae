#pragma once

#include <array>
#include <vector>

#include "traverse/simulation/jet.hpp"

namespace traverse::simulation {

/// A quintic B-spline over equally spaced knots: four times continuously differentiable, and never
/// outside the hull of its control values. Source: de Boor, "A Practical Guide to Splines", 1978,
/// chapter IX (the cardinal B-spline of order 6).
class UniformSpline {
 public:
  enum class Ends { kConstant, kPeriodic };  ///< beyond the control values

  UniformSpline() = default;
  /// Control value i belongs to x = i * step.
  UniformSpline(std::vector<double> controls, double step, Ends ends);

  /// The value and the first three derivatives by x.
  std::array<double, 4> at(double x) const;
  /// The value where x itself moves.
  Jet operator()(const Jet& x) const;

 private:
  double control(long i) const;

  std::vector<double> controls_;
  double step_ = 1;
  Ends ends_ = Ends::kConstant;
};

}  // namespace traverse::simulation
