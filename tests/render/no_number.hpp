#pragma once

#include <limits>

namespace traverse::render {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace traverse::render
