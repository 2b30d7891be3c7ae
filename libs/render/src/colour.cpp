#include "traverse/render/colour.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::render {

namespace {

std::uint8_t mix(std::uint8_t a, std::uint8_t b, double share_of_b) {
  return static_cast<std::uint8_t>(std::lround(a + (b - a) * share_of_b));
}

double linear(std::uint8_t channel) {
  const double c = channel / 255.0;
  return c <= 0.03928 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

double relative_luminance(Colour c) {
  return 0.2126 * linear(c.red) + 0.7152 * linear(c.green) + 0.0722 * linear(c.blue);
}

}  // namespace

Colour mix(Colour a, Colour b, double share_of_b) {
  const double share = std::clamp(share_of_b, 0.0, 1.0);
  return {mix(a.red, b.red, share), mix(a.green, b.green, share), mix(a.blue, b.blue, share)};
}

double contrast_ratio(Colour a, Colour b) {
  const double of_a = relative_luminance(a);
  const double of_b = relative_luminance(b);
  return (std::max(of_a, of_b) + 0.05) / (std::min(of_a, of_b) + 0.05);
}

}  // namespace traverse::render
