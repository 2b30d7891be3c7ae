#pragma once

#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "traverse/config/binder.hpp"

namespace traverse::config {

/// "0 .. 1", "above 0", "0 or more", or nothing for any number.
inline std::string range_text(Range range) {
  // A whole number without a bound of its own ends where an int does, which says nothing to people.
  const bool no_most = range.most >= double{std::numeric_limits<int>::max()};
  if (std::isinf(range.least) && no_most) return {};
  if (range.least == std::numeric_limits<double>::min() && no_most) return "above 0";
  if (no_most) return fmt::format("{:g} or more", range.least);
  if (std::isinf(range.least)) return fmt::format("{:g} or less", range.most);
  return fmt::format("{:g} .. {:g}", range.least, range.most);
}

inline std::string range_suffix(Range range) {
  const std::string text = range_text(range);
  return text.empty() ? text : ", " + text + ",";
}

}  // namespace traverse::config
