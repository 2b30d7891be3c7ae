#pragma once

#include <numbers>

namespace traverse::geometry {

/// One degree in rad: `15 * kDegree`.
inline constexpr double kDegree = std::numbers::pi / 180;

}  // namespace traverse::geometry
