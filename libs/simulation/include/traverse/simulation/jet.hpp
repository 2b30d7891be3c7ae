#pragma once

#include <cmath>

#include <Eigen/Core>

namespace traverse::simulation {

/// A number with its first two derivatives by time. What is computed with jets comes out with its
/// exact velocity and acceleration (forward differentiation of second order).
struct Jet {
  double value = 0;
  double rate = 0;  ///< d/dt
  double bend = 0;  ///< d2/dt2

  Jet() = default;
  Jet(double constant) : value(constant) {}  // NOLINT: numbers mix with jets in formulas
  Jet(double v, double d, double dd) : value(v), rate(d), bend(dd) {}

  Jet& operator+=(const Jet& o) { return *this = {value + o.value, rate + o.rate, bend + o.bend}; }
  Jet& operator-=(const Jet& o) { return *this = {value - o.value, rate - o.rate, bend - o.bend}; }
};

/// f(a) for a function with these value and derivatives at a.value: the chain rule.
inline Jet chain(const Jet& a, double f, double df, double ddf) {
  return {f, df * a.rate, ddf * a.rate * a.rate + df * a.bend};
}

inline Jet operator-(const Jet& a) { return {-a.value, -a.rate, -a.bend}; }
inline Jet operator+(Jet a, const Jet& b) { return a += b; }
inline Jet operator-(Jet a, const Jet& b) { return a -= b; }
inline Jet operator*(const Jet& a, const Jet& b) {
  return {a.value * b.value, a.rate * b.value + a.value * b.rate,
          a.bend * b.value + 2 * a.rate * b.rate + a.value * b.bend};
}
inline Jet inverse(const Jet& a) {
  const double r = 1 / a.value;
  return chain(a, r, -r * r, 2 * r * r * r);
}
inline Jet operator/(const Jet& a, const Jet& b) { return a * inverse(b); }
inline Jet sqrt(const Jet& a) {
  const double r = std::sqrt(a.value);
  return chain(a, r, 0.5 / r, -0.25 / (r * a.value));
}
inline Jet sin(const Jet& a) {
  const double s = std::sin(a.value);
  return chain(a, s, std::cos(a.value), -s);
}
inline Jet cos(const Jet& a) {
  const double c = std::cos(a.value);
  return chain(a, c, -std::sin(a.value), -c);
}

using JetVector = Eigen::Matrix<Jet, 3, 1>;
using JetMatrix = Eigen::Matrix<Jet, 3, 3>;

/// The values, the first or the second derivatives of a matrix of jets.
template <typename Matrix>
auto values(const Matrix& m) {
  return m.unaryExpr([](const Jet& j) { return j.value; }).eval();
}
template <typename Matrix>
auto rates(const Matrix& m) {
  return m.unaryExpr([](const Jet& j) { return j.rate; }).eval();
}
template <typename Matrix>
auto bends(const Matrix& m) {
  return m.unaryExpr([](const Jet& j) { return j.bend; }).eval();
}

}  // namespace traverse::simulation

template <>
struct Eigen::NumTraits<traverse::simulation::Jet> : Eigen::NumTraits<double> {
  using Real = traverse::simulation::Jet;
  using NonInteger = traverse::simulation::Jet;
  using Nested = traverse::simulation::Jet;
  enum { IsComplex = 0, IsInteger = 0, IsSigned = 1, RequireInitialization = 1 };
};
