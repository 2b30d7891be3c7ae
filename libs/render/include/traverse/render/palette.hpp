#pragma once

#include <array>
#include <cstddef>

#include "traverse/render/colour.hpp"

/// The colours that mean something, the same in pictures, report and window. Safe for colour-blind
/// readers. Source: Okabe and Ito, "Color Universal Design", 2008.
namespace traverse::render::palette {

inline constexpr Colour kBlue = Colour::hex(0x0072B2);
inline constexpr Colour kVermillion = Colour::hex(0xD55E00);
inline constexpr Colour kGreen = Colour::hex(0x009E73);
inline constexpr Colour kPurple = Colour::hex(0xCC79A7);
inline constexpr Colour kOrange = Colour::hex(0xE69F00);
inline constexpr Colour kSkyBlue = Colour::hex(0x56B4E9);

/// The estimate is the first series, further estimates follow.
inline constexpr std::array<Colour, 6> kSeries{kBlue,   kVermillion, kGreen,
                                               kPurple, kOrange,     kSkyBlue};
inline constexpr Colour series(std::size_t index) { return kSeries[index % kSeries.size()]; }

inline constexpr Colour kSharp = kVermillion;
inline constexpr Colour kLessSharp = kOrange;
inline constexpr Colour kFlat = kBlue;
inline constexpr Colour kLessFlat = kSkyBlue;

}  // namespace traverse::render::palette
