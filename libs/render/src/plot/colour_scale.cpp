#include "plot/colour_scale.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace traverse::render {

namespace {

constexpr double kLowPercent = 2;
constexpr double kHighPercent = 98;

template <typename Number>
Range finite_range(std::span<const Number> values) {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Number value : values) {
    if (!std::isfinite(value)) continue;
    range.low = std::min(range.low, static_cast<double>(value));
    range.high = std::max(range.high, static_cast<double>(value));
  }
  return range;
}

template <typename Number>
ColourScale scale_of(std::span<const Number> values, ColourMap map) {
  ColourScale scale;
  scale.map = map;
  scale.data = finite_range(values);
  if (scale.data.low > scale.data.high) {
    scale.data = {};
    return scale;
  }
  scale.shown = {percentile(values, kLowPercent), percentile(values, kHighPercent)};
  if (map == ColourMap::kDiverging) {
    const double most = std::max(std::abs(scale.shown.low), std::abs(scale.shown.high));
    scale.shown = {-most, most};
  }
  if (!(scale.shown.span() > 0)) {
    const double room = scale.shown.low == 0 ? 0.5 : 0.05 * std::abs(scale.shown.low);
    scale.shown = {scale.shown.low - room, scale.shown.high + room};
  }
  return scale;
}

}  // namespace

ColourScale colour_scale(std::span<const double> values, ColourMap map) {
  return scale_of(values, map);
}

ColourScale colour_scale(std::span<const float> values, ColourMap map) {
  return scale_of(values, map);
}

}  // namespace traverse::render
