#pragma once

#include <cstdint>

namespace traverse::packets {

/// a + b, or the farthest that has an opposite: stamps and clocks of damaged packets are any
/// number.
inline std::int64_t saturated_sum(std::int64_t a, std::int64_t b) {
  std::int64_t sum = 0;
  if (!__builtin_add_overflow(a, b, &sum) && sum != INT64_MIN) return sum;
  return a < 0 ? -INT64_MAX : INT64_MAX;
}

/// a - b, the same.
inline std::int64_t saturated_difference(std::int64_t a, std::int64_t b) {
  std::int64_t difference = 0;
  if (!__builtin_sub_overflow(a, b, &difference) && difference != INT64_MIN) return difference;
  return a < 0 ? -INT64_MAX : INT64_MAX;
}

}  // namespace traverse::packets
