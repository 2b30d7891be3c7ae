#pragma once

#include <cstdint>

namespace traverse::packets {

/// Numbers as sensors send them, the lowest byte first.
inline std::uint32_t u16_at(const std::uint8_t* bytes) {
  return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8;
}

inline std::uint32_t u32_at(const std::uint8_t* bytes) {
  return u16_at(bytes) | u16_at(bytes + 2) << 16;
}

inline std::uint64_t u64_at(const std::uint8_t* bytes) {
  return u32_at(bytes) | static_cast<std::uint64_t>(u32_at(bytes + 4)) << 32;
}

}  // namespace traverse::packets
