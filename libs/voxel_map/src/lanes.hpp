#pragma once

#include <cstddef>
#include <cstring>
#include <vector>

/// A function of loops over floats, compiled for any x86-64 and for AVX2; the processor chooses
/// when the program starts. Without fused multiply-adds and with sums in written lanes both give
/// the same bits. Not under sanitizers, which are not set up yet when the choice is made.
#if defined(__x86_64__) && !defined(TRAVERSE_SANITIZED)
#define TRAVERSE_AVX2_TOO __attribute__((target_clones("avx2", "default")))
#else
#define TRAVERSE_AVX2_TOO
#endif

namespace traverse::voxel_map {

inline constexpr std::size_t kLanes = 8;

/// Eight floats that are computed with as one: two registers of SSE, one of AVX. Functions take
/// them by reference, because by value they would be passed differently with AVX and without.
using Lanes [[gnu::vector_size(kLanes * sizeof(float))]] = float;

/// Eight values from the `i`-th on; zeros beyond the last.
[[gnu::always_inline]] inline void load(const std::vector<float>& values, std::size_t i,
                                        Lanes& lanes) {
  if (i + kLanes <= values.size()) {
    std::memcpy(&lanes, &values[i], sizeof(Lanes));
    return;
  }
  lanes = Lanes{};
  std::memcpy(&lanes, &values[i], (values.size() - i) * sizeof(float));
}

}  // namespace traverse::voxel_map
