#pragma once

#include <cstdint>

namespace traverse::voxel_map {

/// Cell coordinates packed in 32 bits, 11 for x and y, 10 for z: cells repeat after 2048 (1024)
/// edges, so two cells with one key must never be alive together.
inline std::uint32_t cell_key(std::int32_t x, std::int32_t y, std::int32_t z) {
  return (static_cast<std::uint32_t>(x) & 2047U) << 21U |
         (static_cast<std::uint32_t>(y) & 2047U) << 10U | (static_cast<std::uint32_t>(z) & 1023U);
}

/// Knuth's multiplicative hash: the high bits are the good ones.
inline std::uint32_t spread(std::uint32_t key) { return key * 2654435761U; }

}  // namespace traverse::voxel_map
