#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "traverse/voxel_map/cell_key.hpp"

namespace traverse::voxel_map {

/// The largest whole number not above `value`, for |value| < 2^31; SSE2 has no instruction for it.
inline std::int32_t floor_to_int(float value) {
  const auto whole = static_cast<std::int32_t>(value);
  return whole - static_cast<std::int32_t>(value < static_cast<float>(whole));
}

/// A set of cells, open addressing with linear probing.
class PointHash {
 public:
  /// \param max_points it will be asked to hold
  explicit PointHash(std::size_t max_points)
      : bits_(static_cast<unsigned>(std::bit_width(2 * max_points + 15))),
        slots_(std::size_t{1} << bits_, kEmpty) {}

  static std::uint32_t key(float x, float y, float z) {
    return cell_key(floor_to_int(x), floor_to_int(y), floor_to_int(z));
  }

  /// \returns whether the cell was not there before.
  bool insert(std::uint32_t key) {
    if (key == kEmpty) return !std::exchange(holds_empty_, true);
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = spread(key) >> (32U - bits_);; i = (i + 1) & mask) {
      if (slots_[i] == key) return false;
      if (slots_[i] != kEmpty) continue;
      slots_[i] = key;
      return true;
    }
  }

 private:
  static constexpr std::uint32_t kEmpty = 0xffffffffU;

  unsigned bits_;
  std::vector<std::uint32_t> slots_;
  bool holds_empty_ = false;  // the cell whose key marks a free slot: (-1, -1, -1)
};

}  // namespace traverse::voxel_map
