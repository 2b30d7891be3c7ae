#pragma once

#include <cstdint>

namespace traverse::render {

/// An opaque sRGB colour.
struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;

  /// From the usual six hexadecimal digits: Colour::hex(0x0072B2).
  static constexpr Colour hex(std::uint32_t rgb) {
    return {static_cast<std::uint8_t>(rgb >> 16 & 0xff), static_cast<std::uint8_t>(rgb >> 8 & 0xff),
            static_cast<std::uint8_t>(rgb & 0xff)};
  }

  bool operator==(const Colour&) const = default;
};

/// `share_of_b` of b, the rest a, mixed as the numbers stand (not in linear light).
Colour mix(Colour a, Colour b, double share_of_b);

/// How well a reader tells two colours apart, 1 (not at all) to 21 (black on white).
/// Source: WCAG 2.1, "contrast ratio".
double contrast_ratio(Colour a, Colour b);

}  // namespace traverse::render
