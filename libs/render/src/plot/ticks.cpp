#include "plot/ticks.hpp"

#include <algorithm>
#include <cmath>

#include "plot/number_text.hpp"

namespace traverse::render {

namespace {

constexpr double kRounding = 1e-9;  // relative: 0.1 * 3 is a multiple of 0.1
constexpr double kMostTicksAnywhere = 1000;
constexpr double kLargeCoordinate = 10'000;

int decimals_of(double step) {
  return std::max(0, static_cast<int>(std::ceil(-std::log10(step) - kRounding)));
}

}  // namespace

double nice_step_at_least(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1 - kRounding)) return factor * power;
  }
  return 10 * power;
}

double nice_step_at_most(double most) {
  const double power = std::pow(10, std::floor(std::log10(most)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= most * (1 + kRounding)) return factor * power;
  }
  return power;
}

Ticks ticks_of_step(Range range, double step) {
  Ticks ticks{step, {}};
  const double first = std::ceil(range.low / step - kRounding);
  const double last = std::floor(range.high / step + kRounding);
  // Beyond 2^53 a double knows no next whole number.
  if (!(last - first < kMostTicksAnywhere) || std::max(std::abs(first), std::abs(last)) > 0x1p53) {
    return ticks;
  }
  // The multiples, not a running sum: 0.1 added ten times is not 1.
  for (double multiple = first; multiple <= last; ++multiple) {
    ticks.values.push_back(multiple * step + 0.0);
  }
  return ticks;
}

Ticks nice_ticks(Range range, int at_most) {
  if (!std::isnormal(range.span()) || !(range.span() > 0) || at_most < 1) return {};
  double step = nice_step_at_least(range.span() / at_most);
  // Where the range begins decides whether one more tick fits in than the span alone says.
  while (ticks_of_step(range, step).values.size() > static_cast<std::size_t>(at_most)) {
    step = nice_step_at_least(step * 1.5);
  }
  return ticks_of_step(range, step);
}

Notation Notation::for_range(Range range) {
  const double largest = std::max(std::abs(range.low), std::abs(range.high));
  if (!std::isfinite(largest) || !(range.span() > 0)) return {};
  if (largest >= kLargeCoordinate && range.span() < 0.05 * largest) {
    const double unit = std::pow(10, std::ceil(std::log10(range.span())));
    return {std::floor(range.low / unit) * unit, 0};
  }
  if (largest >= 1e6 || largest < 1e-3) {
    return {0, 3 * static_cast<int>(std::floor(std::log10(largest) / 3))};
  }
  return {};
}

std::string Notation::axis_label(const std::string& name, const std::string& unit) const {
  std::string label = name;
  if (offset > 0) label += " − " + fixed_text(offset, 0);
  if (offset < 0) label += " + " + fixed_text(-offset, 0);
  const std::string power = exponent == 0 ? "" : power_of_ten_text(exponent);
  if (unit.empty() && power.empty()) return label;
  return label + " [" + power + (unit.empty() || power.empty() ? "" : " ") + unit + "]";
}

std::vector<std::string> tick_labels(const Ticks& ticks, const Notation& notation) {
  const double power = std::pow(10, notation.exponent);
  std::vector<std::string> labels;
  for (const double value : ticks.values) {
    labels.push_back(
        fixed_text((value - notation.offset) / power, decimals_of(ticks.step / power)));
  }
  return labels;
}

}  // namespace traverse::render
